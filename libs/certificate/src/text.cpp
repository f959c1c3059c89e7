// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>

#include "holdfast/certificate/certificate.hpp"
#include "sha256.hpp"

namespace holdfast::certificate {
namespace {

constexpr std::string_view kTitle = "holdfast-certificate";
constexpr std::string_view kLaws[] = {"bonded", "regularised", "unilateral"};

/// The end of a module's line: open, pressed, and the signs of its tilts.
constexpr char kSigns[] = {'-', '0', '+'};

struct Named {
  std::string_view name;
  double Material::*value;
};

constexpr Named kNumbers[] = {
    {"pitch_mm", &Material::pitch},
    {"facet_mm", &Material::facet},
    {"section_area_mm2", &Material::area},
    {"moment_x_mm4", &Material::moment_x},
    {"moment_y_mm4", &Material::moment_y},
    {"torsion_mm4", &Material::torsion},
    {"poisson_ratio", &Material::poisson},
    {"mass_kg", &Material::mass},
    {"gravity_m_s2", &Material::gravity},
    {"strength_vertical_n", &Material::strength_vertical},
    {"strength_lateral_n", &Material::strength_lateral},
    {"contact_gamma", &Material::gamma},
};

template <class Number>
void append(std::string& text, Number number) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number);
  text.append(digits, end.ptr);
}

/// Writes as many digits as it takes to read the same double again.
void append(std::string& text, double number) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.17g", number);
  text += digits;
}

/// Writes an integer in hexadecimal digits, with a minus sign if it is negative.
void append_integer(std::string& text, Integer value) {
  constexpr unsigned kDigits = 32;
  char digits[kDigits];
  if (value < 0) {
    text += '-';
  }
  __extension__ auto rest = static_cast<unsigned __int128>(value < 0 ? -value : value);
  unsigned count = 0;
  do {
    digits[count++] = "0123456789abcdef"[static_cast<unsigned>(rest & 15U)];
    rest >>= 4U;
  } while (rest != 0);
  while (count > 0) {
    text += digits[--count];
  }
}

/// FNV-1a of 64 bits [Fowler, Noll and Vo 1991]: against accidents, not against forgers, who would
/// have to prove something true anyway.
std::uint64_t checksum(std::string_view text) {
  std::uint64_t sum = 14695981039346656037U;
  for (const char c : text) {
    sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211U;
  }
  return sum;
}

constexpr std::string_view kEnd = "\nend ";

/// Whether a name can be shown on one line: without control characters, of which the second set is
/// C2 80 to C2 9F.
bool is_one_line(std::string_view name) {
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    const bool is_second = i > 0 && name[i - 1] == '\xC2' && byte < 0xA0;
    if (byte < 0x20 || byte == 0x7F || is_second) {
      return false;
    }
  }
  return true;
}

bool is_ground(const Certificate& certificate, const Module& module) {
  return !module.is_fixed && module.cell[2] == certificate.support_z;
}

/// The twelve numbers and the support level.
void append_material(std::string& text, const Certificate& certificate) {
  for (const auto& [name, value] : kNumbers) {
    text += name;
    text += ' ';
    append(text, certificate.material.*value);
    text += '\n';
  }
  text += "support_z ";
  append(text, certificate.support_z);
  text += '\n';
}

/// Writes a module's cell and what holds it.
void append_module(std::string& text, const Certificate& certificate, const Module& module) {
  for (const std::int32_t coordinate : module.cell) {
    append(text, coordinate);
    text += ' ';
  }
  text += module.is_fixed ? "fixed" : is_ground(certificate, module) ? "ground" : "free";
}

void append_state(std::string& text, const State& state) {
  text += state.is_pressed ? " pressed " : " open ";
  text += kSigns[state.tilt_x + 1];
  text += kSigns[state.tilt_y + 1];
}

/// Words one after the other. After a fault all that follows is empty.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string_view next() {
    while (!text_.empty() && is_blank(text_.front())) {
      line_ += text_.front() == '\n' ? 1 : 0;
      text_.remove_prefix(1);
    }
    std::size_t length = 0;
    while (length < text_.size() && !is_blank(text_[length])) {
      ++length;
    }
    const std::string_view word = text_.substr(0, length);
    text_.remove_prefix(length);
    return word;
  }

  /// All that is left of the line, without the blank in front of it.
  std::string_view line() {
    const std::size_t length = std::min(text_.find('\n'), text_.size());
    std::string_view rest = text_.substr(0, length);
    text_.remove_prefix(length);
    if (!rest.empty() && is_blank(rest.front())) {
      rest.remove_prefix(1);
    }
    return rest;
  }

  bool is_at_end() { return next().empty(); }

  void expect(std::string_view word) {
    if (next() != word) {
      fail(std::string(word));
    }
  }

  template <class Number>
  Number number(std::string_view what) {
    const std::string_view word = next();
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) {
      fail(std::string(what));
      return {};
    }
    return value;
  }

  double real(std::string_view what) {
    const std::string word(next());
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (word.empty() || end != word.c_str() + word.size()) {
      fail(std::string(what));
      return 0;
    }
    return value;
  }

  /// Reads an integer of at most 30 hexadecimal digits, so that nothing overflows.
  Integer integer() {
    std::string_view word = next();
    const bool is_negative = !word.empty() && word.front() == '-';
    word.remove_prefix(is_negative ? 1 : 0);
    if (word.empty() || word.size() > 30) {
      fail("a number of 1 to 30 hexadecimal digits");
      return 0;
    }
    Integer value = 0;
    for (const char digit : word) {
      unsigned part = 0;
      const auto [end, error] = std::from_chars(&digit, &digit + 1, part, 16);
      if (error != std::errc() || end != &digit + 1) {
        fail("a hexadecimal number");
        return 0;
      }
      value = value * 16 + static_cast<Integer>(part);
    }
    return is_negative ? -value : value;
  }

  void fail(const std::string& expected) {
    if (fault_.empty()) {
      fault_ = "line " + std::to_string(line_) + ": expected " + expected;
    }
    text_ = {};
  }

  const std::string& fault() const { return fault_; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r'; }

  std::string_view text_;
  int line_ = 1;
  std::string fault_;
};

State read_state(Words& words) {
  const std::string_view word = words.next();
  const std::string_view signs = words.next();
  const auto sign = [&](std::size_t i) {
    const std::size_t place = std::string_view(kSigns, 3).find(signs.size() == 2 ? signs[i] : '?');
    return place == std::string_view::npos ? 2 : static_cast<int>(place) - 1;
  };
  const State state = {.is_pressed = word == "pressed", .tilt_x = sign(0), .tilt_y = sign(1)};
  if ((word != "pressed" && word != "open") || state.tilt_x > 1 || state.tilt_y > 1) {
    words.fail("'open' or 'pressed', and two of '-', '0', '+'");
  }
  return state;
}

Module read_module(Words& words, const Certificate& certificate) {
  Module module;
  for (std::int32_t& coordinate : module.cell) {
    coordinate = words.number<std::int32_t>("a coordinate");
    if (coordinate > 1'000'000 || coordinate < -1'000'000) {
      words.fail("a coordinate from -1000000 to 1000000");
    }
  }
  const std::string_view kind = words.next();
  module.is_fixed = kind == "fixed";
  if (kind == "ground") {
    module.state = read_state(words);
  }
  const bool has_facet = is_ground(certificate, module);
  if (kind != "fixed" && kind != (has_facet ? "ground" : "free")) {
    words.fail(has_facet ? "'ground' or 'fixed'" : "'free' or 'fixed'");
  }
  return module;
}

void read_head(Words& words, Certificate& certificate) {
  words.expect(kTitle);
  if (words.next() != "2") {
    words.fail("version 2; 'holdfast check --certificate' makes them again");
  }
  words.expect("robot");
  certificate.name = words.line();
  if (!is_one_line(certificate.name)) {
    words.fail("a name without control characters");
  }
  words.expect("law");
  const std::string_view law = words.next();
  bool is_known = false;
  for (std::size_t i = 0; i < std::size(kLaws); ++i) {
    if (law == kLaws[i]) {
      certificate.law = static_cast<Law>(i);
      is_known = true;
    }
  }
  if (!is_known) {
    words.fail("a law");
  }
  for (const auto& [name, value] : kNumbers) {
    words.expect(name);
    certificate.material.*value = words.real("a number");
  }
  words.expect("support_z");
  certificate.support_z = words.number<std::int32_t>("a number");
  words.expect("bits");
  certificate.bits = words.number<int>("a number");
}

void append_planned(std::string& text, const Certificate& certificate) {
  text += "\nplanned ";
  append(text, certificate.planned_count);
}

void read_modules(Words& words, Certificate& certificate) {
  const auto count = words.number<std::size_t>("how many");
  for (std::size_t i = 0; i < count && words.fault().empty(); ++i) {
    certificate.modules.push_back(read_module(words, certificate));
  }
}

}  // namespace

std::string write(const Certificate& certificate) {
  std::string text = std::string(kTitle) + " 2\nrobot ";
  text += is_one_line(certificate.name) ? certificate.name : "";
  text += "\nlaw ";
  text += kLaws[static_cast<std::size_t>(certificate.law)];
  text += '\n';
  append_material(text, certificate);
  text += "bits ";
  append(text, certificate.bits);
  const std::size_t existing_count = certificate.modules.size() - certificate.planned_count;
  text += "\nexisting ";
  append(text, existing_count);
  for (std::size_t i = 0; i < certificate.modules.size(); ++i) {
    if (i == existing_count) {
      append_planned(text, certificate);
    }
    const Module& module = certificate.modules[i];
    text += '\n';
    append_module(text, certificate, module);
    if (is_ground(certificate, module)) {
      append_state(text, module.state);
    }
  }
  if (certificate.planned_count == 0) {
    append_planned(text, certificate);
  }
  text += "\nfields ";
  append(text, certificate.fields.size());
  for (const Field& field : certificate.fields) {
    for (const Six& six : field) {
      text += '\n';
      for (std::size_t i = 0; i < 6; ++i) {
        text += i == 0 ? "" : " ";
        append_integer(text, six[i]);
      }
    }
  }
  const std::uint64_t sum = checksum(text);
  text += kEnd;
  append_integer(text, static_cast<Integer>(sum));
  return text + '\n';
}

Reading read(std::string_view text) {
  Reading reading;
  Certificate& certificate = reading.certificate;
  Words words(text);
  read_head(words, certificate);
  words.expect("existing");
  read_modules(words, certificate);
  const std::size_t existing_count = certificate.modules.size();
  words.expect("planned");
  read_modules(words, certificate);
  const std::size_t count = certificate.modules.size();
  certificate.planned_count = count - existing_count;
  words.expect("fields");
  const auto field_count = words.number<std::size_t>("how many");
  for (std::size_t field = 0; field < field_count && words.fault().empty(); ++field) {
    certificate.fields.emplace_back();
    for (std::size_t i = 0; i < count && words.fault().empty(); ++i) {
      Six& six = certificate.fields.back().emplace_back();
      for (Integer& value : six) {
        value = words.integer();
      }
    }
  }
  words.expect("end");
  if (words.integer() != static_cast<Integer>(checksum(text.substr(0, text.rfind(kEnd))))) {
    words.fail("the checksum of all before 'end'");
  }
  if (words.fault().empty() && !words.is_at_end()) {
    words.fail("nothing after 'end'");
  }
  reading.fault = words.fault();
  return reading;
}

std::string digest(const Certificate& certificate) {
  const std::size_t existing_count = certificate.modules.size() - certificate.planned_count;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < certificate.modules.size(); ++i) {
    std::string& line = lines.emplace_back();
    append_module(line, certificate, certificate.modules[i]);
    line += i < existing_count ? " existing\n" : " planned\n";
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  append_material(text, certificate);
  for (const std::string& line : lines) {
    text += line;
  }
  return sha256(text);
}

std::string robot_words(std::string_view name, std::size_t module_count,
                        std::size_t planned_count) {
  std::string words(name.empty() ? "without a name" : name);
  words += ", " + std::to_string(module_count) + (module_count == 1 ? " module" : " modules");
  if (planned_count > 0) {
    words += ", " + std::to_string(planned_count) + " of them planned";
  }
  return words;
}

}  // namespace holdfast::certificate
