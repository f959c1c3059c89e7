// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/file_ending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace holdfast {
namespace {

/// A format that is written, and the endings of such files.
struct Endings {
  FileFormat format;
  std::string_view name;
  std::vector<std::string_view> own;
  bool is_told_by_ending = false;  ///< So that one that none of them has says nothing.

  bool takes(std::string_view ending) const { return std::ranges::find(own, ending) != own.end(); }
};

const std::vector<Endings>& formats() {
  static const std::vector<Endings> all = {
      {FileFormat::kJson, "JSON", {".json"}},
      {FileFormat::kStructure, "a structure", {".json", ".xml", ".holdfast"}, true},
      {FileFormat::kPlan, "holdfast JSON or VisibleSim XML", {".json", ".xml"}, true},
      {FileFormat::kCsv, "CSV", {".csv"}},
      {FileFormat::kSvg, "SVG", {".svg"}},
      {FileFormat::kFigure, "SVG, PNG or PDF", {".svg", ".png", ".pdf"}, true},
      {FileFormat::kVtu, "VTK's XML format", {".vtu"}},
      {FileFormat::kPvd, "a list of .vtu files", {".pvd"}},
      {FileFormat::kHtml, "HTML", {".html", ".htm"}}};
  return all;
}

/// The endings of formats that nothing here writes.
constexpr std::string_view kOtherEndings[] = {".png", ".pdf",    ".jpg", ".jpeg", ".gif", ".eps",
                                              ".vtk", ".vtkhdf", ".stl", ".obj",  ".md"};

/// ".svg, .png or .pdf".
std::string endings_of(const Endings& format) {
  std::string text;
  for (std::size_t i = 0; i < format.own.size(); ++i) {
    text += i == 0 ? "" : i + 1 == format.own.size() ? " or " : ", ";
    text += format.own[i];
  }
  return text;
}

}  // namespace

std::string ending_of(std::string_view path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return ending;
}

bool has_ending(std::string_view path, std::string_view ending) {
  return ending_of(path) == ending;
}

bool has_ending_of(FileFormat format, std::string_view path) {
  return std::ranges::find(formats(), format, &Endings::format)->takes(ending_of(path));
}

std::optional<base::Error> find_foreign_ending(FileFormat format, std::string_view path) {
  const std::string ending = ending_of(path);
  const auto own = std::ranges::find(formats(), format, &Endings::format);
  const bool is_foreign =
      (own->is_told_by_ending && !ending.empty()) ||
      std::ranges::find(kOtherEndings, ending) != std::end(kOtherEndings) ||
      std::ranges::any_of(formats(), [&](const Endings& other) { return other.takes(ending); });
  if (!is_foreign || own->takes(ending)) {
    return std::nullopt;
  }
  return base::bad_input(
      fmt::format("what is written is {}, whose files end in {}", own->name, endings_of(*own)));
}

}  // namespace holdfast
