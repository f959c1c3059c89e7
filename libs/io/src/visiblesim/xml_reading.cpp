// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "visiblesim/xml_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// More elements cannot be a structure of kModuleCountMax modules.
constexpr std::size_t kElementCountMax = model::kModuleCountMax + 10'000;

constexpr std::size_t kFoundShownMax = 100;

/// The entity at the beginning of a text, from '&' to ';'; empty if it is a mere ampersand.
std::string_view entity_of(std::string_view text) {
  std::size_t i = 1;
  const auto is_part = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '#';
  };
  while (i < text.size() && is_part(text[i])) {
    ++i;
  }
  return i > 1 && i < text.size() && text[i] == ';' ? text.substr(0, i + 1) : std::string_view();
}

/// Whether the parser reads an entity as what it stands for. It knows none that a file declares,
/// and ends a value at a character 0.
bool is_read(std::string_view entity) {
  constexpr std::string_view kNamed[] = {"&lt;", "&gt;", "&amp;", "&quot;", "&apos;"};
  return entity.starts_with("&#") ? entity.find_first_not_of("&#xX0;") != std::string_view::npos
                                  : std::ranges::find(kNamed, entity) != std::end(kNamed);
}

/// Counts the depth and number of elements, and entities in attributes, in one pass before the
/// parser takes memory for them. Goes from '<' to '<'; whether the text is well-formed is left to
/// the parser.
class ShapeCheck {
 public:
  explicit ShapeCheck(std::string_view text) : text_(text) {}

  std::optional<base::Error> run() {
    for (std::size_t i = text_.find('<'); i < text_.size(); i = text_.find('<', i)) {
      const std::size_t begin = i;
      step(i);
      if (std::ssize(open_) > kNestingMax) {
        return syntax_error(text_, begin,
                            fmt::format("elements nested deeper than the {} allowed", kNestingMax));
      }
      if (unread_at_ < text_.size()) {
        return syntax_error(text_, unread_at_,
                            fmt::format("the entity {} is unknown, expected &lt; &gt; &amp; "
                                        "&quot; &apos; and numbers of characters but 0",
                                        entity_of(text_.substr(unread_at_))));
      }
      if (count_ > kElementCountMax) {
        return syntax_error(text_, begin,
                            fmt::format("more than the {} elements allowed", kElementCountMax));
      }
    }
    if (!open_.empty() && !unclosed_) {
      unclosed_ = {open_.back(), text_.size()};
    }
    return std::nullopt;
  }

  /// Names the first element that ends where another one does, or not at all.
  std::optional<base::Error> find_unclosed() const {
    if (!unclosed_) {
      return std::nullopt;
    }
    const auto [begin, end] = *unclosed_;
    const std::string what = fmt::format("no well-formed XML: the element {} of {} is not closed",
                                         excerpt(name_at(begin + 1)), line_at(text_, begin));
    return end < text_.size()
               ? syntax_error(text_, end, what)
               : base::Error{base::ErrorCode::kBadInput, what + ", found the end of the text",
                             line_at(text_, end)};
  }

 private:
  std::string_view name_at(std::size_t begin) const {
    const std::string_view rest = text_.substr(begin);
    return rest.substr(0, rest.find_first_of(" \t\r\n/>"));
  }

  void close(std::size_t begin) {
    if (!open_.empty()) {
      if (!unclosed_ && name_at(begin + 2) != name_at(open_.back() + 1)) {
        unclosed_ = {open_.back(), begin};
      }
      open_.pop_back();
    }
  }

  /// Moves i from a '<' to the end of what it begins.
  void step(std::size_t& i) {
    const std::string_view rest = text_.substr(i);
    if (rest.starts_with("<!--")) {
      skip(i, 4, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      skip(i, 9, "]]>");
    } else if (rest.starts_with("<?")) {
      skip(i, 2, "?>");
    } else if (rest.starts_with("</")) {
      close(i);
      i += 2;
    } else if (rest.starts_with("<!")) {
      i += 2;
    } else {
      ++count_;
      open_.push_back(i);
      skip_tag(i);
    }
  }

  void skip(std::size_t& i, std::size_t length, std::string_view end) {
    i = std::min(text_.find(end, i + length), text_.size());
  }

  /// Moves i to the '>' that ends a tag, past those in attribute values.
  void skip_tag(std::size_t& i) {
    char quote = '\0';
    for (++i; i < text_.size(); ++i) {
      const char c = text_[i];
      if (quote != '\0') {
        quote = c == quote ? '\0' : quote;
        if (c == '&') {
          note_entity(i);
        }
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '>' || c == '<') {
        if (c == '>' && text_[i - 1] == '/') {
          open_.pop_back();
        }
        return;
      }
    }
  }

  void note_entity(std::size_t i) {
    const std::string_view entity = entity_of(text_.substr(i));
    if (!entity.empty() && !is_read(entity)) {
      unread_at_ = std::min(unread_at_, i);
    }
  }

  std::string_view text_;
  std::vector<std::size_t> open_;  ///< Where the elements begin that have not ended.
  std::optional<std::pair<std::size_t, std::size_t>> unclosed_;  ///< Its begin, and where it ends.
  std::size_t count_ = 0;
  std::size_t unread_at_ = std::string_view::npos;  ///< The first entity that is not read.
};

/// A position as older versions write it, or as programs print it: in parentheses, with decimals,
/// of which VisibleSim takes the whole part, or without z, which is 0 then.
std::optional<std::array<std::int32_t, 3>> whole_parts(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('(') && text.ends_with(')')) {
    text = text.substr(1, text.size() - 2);
  }
  auto numbers = parse_triple<double>(text);
  if (!numbers) {
    numbers = parse_triple<double>(std::string(text) + ",0");
  }
  std::array<std::int32_t, 3> whole{};
  for (std::size_t i = 0; numbers && i < 3; ++i) {
    if (!kCoordinateRange.contains((*numbers)[i])) {
      return std::nullopt;
    }
    whole[i] = static_cast<std::int32_t>((*numbers)[i]);
  }
  return numbers ? std::optional(whole) : std::nullopt;
}

bool is_text(const pugi::xml_node& node) {
  return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

}  // namespace

void XmlReading::parse(pugi::xml_document& tree) {
  ShapeCheck shape(text_);
  if (const auto fault = shape.run()) {
    fail(*fault);
    return;
  }
  // A fragment, because VisibleSim's files have two root elements.
  const auto result = tree.load_buffer(
      text_.data(), text_.size(), pugi::parse_default | pugi::parse_fragment, pugi::encoding_utf8);
  if (result.status == pugi::status_out_of_memory) {
    throw std::bad_alloc();  // It is not the file that is at fault.
  }
  const auto unclosed =
      result.status == pugi::status_end_element_mismatch ? shape.find_unclosed() : std::nullopt;
  if (unclosed) {
    fail(*unclosed);
  } else if (!result) {
    fail(syntax_error(text_, static_cast<std::size_t>(result.offset),
                      fmt::format("no well-formed XML ({})", result.description())));
  }
}

std::string XmlReading::line(const pugi::xml_node& node) const {
  return line_at(text_, static_cast<std::size_t>(node.offset_debug()));
}

void XmlReading::fail(const pugi::xml_node& node, std::string message, base::ErrorCode code) {
  if (!has_failed()) {
    fail({code, std::move(message), line(node)});
  }
}

void XmlReading::warn_at(const pugi::xml_node& node, std::string message) {
  warn(std::move(message), [&] { return line(node); });
}

void XmlReading::expect_attributes(const pugi::xml_node& node, Names known) {
  for (const auto& [name, value] : attributes(node, [](std::string_view) { return false; })) {
    if (std::ranges::find(known, name) == known.end()) {
      note_unknown(fmt::format("the attribute {} of <{}>", excerpt(name), node.name()), name, known,
                   "ignored", [&] { return line(node); });
    }
  }
}

void XmlReading::expect_no_content(const pugi::xml_node& node) {
  if (node.first_child()) {
    warn_at(node, fmt::format("the content of <{}> is ignored", node.name()));
  }
}

void XmlReading::warn_of_unknown_child(const pugi::xml_node& child, Names known) {
  if (!is_text(child)) {
    note_unknown(fmt::format("the element {}", excerpt(child.name())), child.name(), known,
                 "ignored here", [&] { return line(child); });
  } else if (is_conflict_marker(trimmed(child.value()))) {
    fail(child, std::string(kConflict) + " at " + excerpt(trimmed(child.value())));
  } else {
    warn_at(child, "text outside of elements is ignored");
  }
}

Attributes XmlReading::attributes(const pugi::xml_node& node,
                                  bool (*is_read)(std::string_view name)) {
  Attributes all;
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    const std::string_view name = attribute.name();
    if (find_attribute(all, name) != nullptr) {
      fail(node, fmt::format("the attribute {} of {} is there twice, whatever the case of its "
                             "letters; expected once",
                             excerpt(name), excerpt(node.name())));
    }
    if (all.size() == kAttributeCountMax) {
      fail(node,
           fmt::format("{} has more than {} attributes", excerpt(node.name()), kAttributeCountMax));
      break;
    }
    if (const auto fault = find_name_fault(name)) {
      fail(node, *fault);
    }
    if (const auto fault = find_string_fault(attribute.value())) {
      fail(node, fmt::format("the attribute {} {}", excerpt(name), *fault));
    }
    all.emplace_back(name, attribute.value());
  }
  std::erase_if(all, [&](const auto& attribute) { return is_read(attribute.first); });
  return all;
}

const char* XmlReading::required(const pugi::xml_node& node, const char* name) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute) {
    std::string found;
    for (const pugi::xml_attribute& other : node.attributes()) {
      found += (found.empty() ? ", found " : ", ") + excerpt(other.name());
      if (found.size() > kFoundShownMax) {
        break;
      }
    }
    fail(node, fmt::format("<{}> has no attribute '{}'{}", node.name(), name, found));
    return nullptr;
  }
  return attribute.value();
}

double XmlReading::number(const pugi::xml_node& node, const pugi::xml_attribute& attribute) {
  const auto number = parse_number<double>(attribute.value());
  if (!number) {
    fail(node, fmt::format("{} of <{}> is {}, expected a finite number", attribute.name(),
                           node.name(), excerpt(attribute.value())));
  }
  return number.value_or(0);
}

std::int32_t XmlReading::integer(const pugi::xml_node& node, const pugi::xml_attribute& attribute,
                                 IntegerRange range) {
  const auto number = parse_number<double>(attribute.value());
  if (!number || !range.contains(*number) || *number != std::trunc(*number)) {
    fail(node, fmt::format("{} of <{}> is {}, expected an integer from {} to {}", attribute.name(),
                           node.name(), excerpt(attribute.value()), range.lowest, range.highest));
    return 0;
  }
  return static_cast<std::int32_t>(*number);
}

std::array<std::int32_t, 3> XmlReading::triple(const pugi::xml_node& node, const char* name,
                                               IntegerRange range) {
  const char* const text = required(node, name);
  const auto triple = text == nullptr ? std::nullopt : parse_triple<std::int32_t>(text);
  if (text != nullptr &&
      (!triple || !std::ranges::all_of(*triple, [&](auto n) { return range.contains(n); }))) {
    fail(node, fmt::format("{} of <{}> is {}, expected three integers from {} to {}, such as "
                           "1,2,3",
                           name, node.name(), excerpt(text), range.lowest, range.highest));
  }
  return triple.value_or(std::array<std::int32_t, 3>{});
}

base::Cell XmlReading::cell(const pugi::xml_node& node) {
  const char* const text = required(node, "position");
  if (text == nullptr) {
    return {};
  }
  const auto exact = parse_triple<std::int32_t>(text);
  const auto loose = exact ? std::nullopt : whole_parts(text);
  const auto position = exact ? exact : loose;
  if (!position || !std::ranges::all_of(
                       *position, [](std::int32_t n) { return kCoordinateRange.contains(n); })) {
    triple(node, "position", kCoordinateRange);  // Says what is wrong.
    return {};
  }
  const auto [x, y, z] = *position;
  if (loose) {
    warn_at(node, fmt::format("a position is {}, taken to be {},{},{}", excerpt(text), x, y, z));
  }
  return {x, y, z};
}

std::optional<Color> XmlReading::color(const pugi::xml_node& node) {
  const pugi::xml_attribute attribute = node.attribute("color");
  return attribute ? take_color(node.name(), attribute.value(), [&] { return line(node); })
                   : std::nullopt;
}

void XmlReading::take_back_shift(const pugi::xml_node& own) {
  if (!own.attribute(kShift)) {
    return;
  }
  const std::array<std::int32_t, 3> by = triple(own, kShift, {0, base::kCoordinateMax});
  shift_ = {by[0], by[1], by[2]};
  const auto move = [&](base::Cell& cell) {
    cell = {cell.x - shift_.x, cell.y - shift_.y, cell.z - shift_.z};
    if (!kCoordinateRange.contains(std::min({cell.x, cell.y, cell.z}))) {
      fail(own,
           fmt::format("without the shift a cell is ({},{},{}), expected coordinates from "
                       "{} to {}",
                       cell.x, cell.y, cell.z, kCoordinateRange.lowest, kCoordinateRange.highest));
    }
  };
  if (document.extension.has_floor) {
    base::Cell support = {shift_.x, shift_.y, document.support_z};
    move(support);
    document.support_z = support.z;
  }
  for (model::Obstacle& obstacle : document.extension.obstacles) {
    std::ranges::for_each(obstacle.cells, move);
    if (obstacle.cells.empty()) {
      move(obstacle.from);
      move(obstacle.to);
    }
  }
  std::ranges::for_each(document.modules, move, &ModuleEntry::cell);
  for (Step& step : document.steps) {
    std::ranges::for_each(step, move, &PlannedEntry::cell);
  }
}

Element XmlReading::element(const pugi::xml_node& node, int depth) {
  Element element;
  element.name = node.name();
  element.attributes = attributes(node, [](std::string_view) { return false; });
  if (depth > kSceneryNestingMax) {
    fail(node, fmt::format("elements nested deeper than the {} allowed", kSceneryNestingMax));
    return element;
  }
  for (const pugi::xml_node& child : node.children()) {
    if (is_text(child)) {
      element.text += child.value();
    } else {
      element.children.push_back(this->element(child, depth + 1));
    }
    if (has_failed()) {
      return element;
    }
  }
  element.text = trimmed(element.text);
  if (const auto fault = find_name_fault(element.name)) {
    fail(node, *fault);
  }
  if (const auto fault = find_string_fault(element.text)) {
    fail(node, fmt::format("the text of {} {}", excerpt(element.name), *fault));
  }
  return element;
}

}  // namespace holdfast::io
