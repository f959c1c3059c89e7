// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "numbers.hpp"
#include "text_input.hpp"
#include "visiblesim/csg.hpp"

namespace holdfast::io {

/// Reads the text of a Solid. The first fault counts; after it nothing is read.
class SolidParser {
 public:
  explicit SolidParser(std::string_view text) : rest_(text) {}

  base::Result<Solid> run() {
    solid_.nodes_.emplace_back();
    read_list(0, 1, '\0');
    if (!fault_ && solid_.nodes_.size() == 1) {
      fail("no solid");
    }
    if (fault_) {
      return base::bad_input(*fault_);
    }
    solid_.make_boxes();
    return std::move(solid_);
  }

 private:
  using Kind = Solid::Kind;

  /// A word, what it makes, and how many numbers it takes.
  struct Word {
    std::string_view name;
    Kind kind;
    std::size_t number_count_min;
    std::size_t number_count_max;
    bool is_leaf;
  };

  static constexpr auto kWords =
      std::to_array<Word>({{"union", Kind::kUnion, 0, 0, false},
                           {"difference", Kind::kDifference, 0, 0, false},
                           {"intersection", Kind::kIntersection, 0, 0, false},
                           {"translate", Kind::kTranslate, 3, 3, false},
                           {"rotate", Kind::kRotate, 3, 3, false},
                           {"scale", Kind::kScale, 3, 3, false},
                           {"color", Kind::kColor, 3, 4, false},
                           {"cube", Kind::kCube, 3, 3, true},
                           {"sphere", Kind::kSphere, 1, 1, true},
                           {"cylinder", Kind::kCylinder, 2, 3, true},
                           {"torus", Kind::kTorus, 2, 2, true}});

  void fail(const std::string& found) {
    if (!fault_) {
      fault_ = fmt::format(
          "found {} in content of <csg>, expected union, difference, intersection, translate, "
          "rotate, scale, color, cube, sphere, cylinder, torus",
          found);
    }
  }

  /// Whether a part begins here.
  static bool begins_part(std::string_view text) {
    return std::ranges::any_of(kWords, [&](const Word& word) {
      return text.starts_with(word.name) && trimmed(text.substr(word.name.size())).starts_with('(');
    });
  }

  /// Skips blanks and comments, which end where the next part begins, or the end of a list: XML
  /// makes a blank of the end of a line.
  void skip_blanks() {
    rest_ = trimmed(rest_);
    if (!rest_.starts_with("//")) {
      return;
    }
    while (!rest_.empty() && !rest_.starts_with('}') && !begins_part(rest_)) {
      rest_.remove_prefix(1);
    }
  }

  bool take(char mark) {
    skip_blanks();
    const bool is_there = rest_.starts_with(mark);
    rest_.remove_prefix(is_there ? 1 : 0);
    return is_there;
  }

  std::string_view word() {
    skip_blanks();
    std::size_t size = 0;
    while (size < rest_.size() && ((rest_[size] >= 'a' && rest_[size] <= 'z') ||
                                   (rest_[size] >= 'A' && rest_[size] <= 'Z'))) {
      ++size;
    }
    const std::string_view found = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return found;
  }

  /// Reads parts up to `end`, or to the end of the text where that is 0, as children of a node.
  void read_list(std::size_t parent, int depth, char end) {
    while (!fault_) {
      while (take(';')) {
      }
      skip_blanks();
      if (end != '\0' ? take(end) : rest_.empty()) {
        return;
      }
      read_part(parent, depth);
    }
  }

  void read_part(std::size_t parent, int depth) {
    const std::string_view before = rest_;
    const std::string_view name = word();
    const auto* const known = std::ranges::find(kWords, name, &Word::name);
    if (known == kWords.end() || !take('(')) {
      fail(excerpt(before));
      return;
    }
    if (depth > Solid::kDepthMax || solid_.nodes_.size() >= Solid::kNodeCountMax) {
      fail(depth > Solid::kDepthMax ? "parts nested too deep" : "too many parts");
      return;
    }
    const std::size_t index = solid_.nodes_.size();
    solid_.nodes_.emplace_back().kind = known->kind;
    solid_.nodes_[parent].children.push_back(index);
    read_arguments(index, *known);
    if (known->is_leaf || fault_ || take(';')) {
      return;
    }
    if (take('{')) {
      read_list(index, depth + 1, '}');
    } else {
      read_part(index, depth + 1);
    }
  }

  void read_arguments(std::size_t index, const Word& word) {
    Solid::Node& node = solid_.nodes_[index];
    std::vector<double> numbers;
    while (!fault_ && !take(')')) {
      if (take('[') || take(']') || take(',')) {
        continue;
      }
      if (rest_.starts_with("center")) {
        rest_.remove_prefix(6);
        if (!take('=')) {
          fail(excerpt(rest_));
        }
        skip_blanks();
      }
      if (rest_.starts_with("true") || rest_.starts_with("false")) {
        node.is_centred = this->word() == "true";
      } else {
        numbers.push_back(sum(0));
      }
      if (numbers.size() > word.number_count_max) {
        fail("too many numbers");
      }
    }
    if (!fault_ && numbers.size() < word.number_count_min) {
      fail(fmt::format("{} numbers of {}", numbers.size(), word.name));
    }
    if (word.kind == Kind::kCylinder && numbers.size() == 2) {
      numbers.push_back(numbers.back());
    }
    std::copy_n(numbers.begin(), std::min<std::size_t>(numbers.size(), 3), node.numbers.begin());
    expect_size(node);
  }

  /// A size is positive, and no number is so large that it leaves the range of double.
  void expect_size(const Solid::Node& node) {
    const bool is_in_range = std::ranges::all_of(
        node.numbers, [](double number) { return std::abs(number) <= kPositiveMax; });
    const bool is_divisor = node.kind == Kind::kScale;
    const bool has_zero = std::ranges::find(node.numbers, 0.0) != node.numbers.end();
    const bool has_height = node.kind != Kind::kCylinder || node.numbers[0] > 0;
    if (!is_in_range || (is_divisor && has_zero) || !has_height) {
      fail("a size that no solid can have");
    }
  }

  /// A sum of products of numbers in plain arithmetic.
  double sum(int depth) {
    double value = product(depth);
    while (!fault_) {
      if (take('+')) {
        value += product(depth);
      } else if (take('-')) {
        value -= product(depth);
      } else {
        return value;
      }
    }
    return 0;
  }

  double product(int depth) {
    double value = factor(depth);
    while (!fault_) {
      if (take('*')) {
        value *= factor(depth);
      } else if (take('/')) {
        value /= factor(depth);
      } else {
        return value;
      }
    }
    return 0;
  }

  double factor(int depth) {
    if (depth > Solid::kDepthMax) {
      fail("arithmetic nested too deep");
      return 0;
    }
    if (take('-')) {
      return -factor(depth + 1);
    }
    if (take('(')) {
      const double value = sum(depth + 1);
      if (!take(')')) {
        fail(excerpt(rest_));
      }
      return value;
    }
    std::size_t size = std::min(rest_.find_first_not_of("0123456789.eE"), rest_.size());
    const bool has_signed_power = size < rest_.size() && size > 1 &&
                                  (rest_[size - 1] == 'e' || rest_[size - 1] == 'E') &&
                                  (rest_[size] == '-' || rest_[size] == '+');
    if (has_signed_power) {
      size = std::min(rest_.find_first_not_of("0123456789", size + 1), rest_.size());
    }
    const auto number = parse_number<double>(rest_.substr(0, size));
    if (!number) {
      fail(rest_.empty() ? "its end" : excerpt(rest_));
    }
    rest_.remove_prefix(size);
    return number.value_or(0);
  }

  std::string_view rest_;
  Solid solid_;
  std::optional<std::string> fault_;
};

base::Result<Solid> Solid::parse(std::string_view text) { return SolidParser(text).run(); }

}  // namespace holdfast::io
