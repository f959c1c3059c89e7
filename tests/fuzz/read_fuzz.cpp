// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Any bytes are either refused with one printable line, or read as a document that JSON and
// VisibleSim XML give back as it is.
// HOLDFAST_FUZZ_READER is the reader under test: read_json, read_visiblesim, or read_by_ending for
// the formats of other programs, where the first byte says how the file's name ends.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>

#include "holdfast/io/document.hpp"

namespace holdfast::io {
namespace {

/// Larger documents are legal, but slow under sanitizers: <blockBox> makes millions of few bytes.
constexpr std::size_t kModuleCountFuzzed = 2000;

/// Room for all keys of the object that has most, and for what was found in their place.
constexpr std::size_t kLineBytesMax = 600;

void demand(bool is_true) {
  if (!is_true) {
    std::abort();
  }
}

bool is_printable_line(std::string_view text) {
  return text.size() <= kLineBytesMax &&
         std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

[[maybe_unused]] base::Result<ReadDocument> read_by_ending(std::string_view bytes) {
  constexpr std::string_view kEndings[] = {".csv", ".xyz", ".txt", ".json", ".vox",   ".stl",
                                           ".obj", ".ldr", "",     ".scen", ".record"};
  if (bytes.empty()) {
    return read_document(bytes);
  }
  const auto choice = static_cast<unsigned char>(bytes.front()) % std::size(kEndings);
  return read_document(bytes.substr(1),
                       {.ending = std::string(kEndings[choice]), .mesh_pitch = 1.0});
}

void demand_good_error(const base::Error& error) {
  demand(!error.message.empty());
  demand(is_printable_line(error.message));
  demand(is_printable_line(error.where));
}

void read(std::string_view text) {
  const auto read = HOLDFAST_FUZZ_READER(text);
  if (!read) {
    demand_good_error(read.error());
    return;
  }
  const Document& document = read.value().document;
  demand(std::ranges::all_of(read.value().warnings, is_printable_line));
  if (document.modules.size() > kModuleCountFuzzed) {
    return;
  }
  const auto robot = make_robot(document);
  if (!robot) {
    demand_good_error(robot.error());
  }
  const auto from_json = read_json(write_json(document));
  demand(from_json && from_json.value().document == document);
  const auto from_xml = read_visiblesim(write_visiblesim(document));
  demand(from_xml && from_xml.value().document == document);
}

}  // namespace
}  // namespace holdfast::io

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  holdfast::io::read({reinterpret_cast<const char*>(data), size});
  return 0;
}
