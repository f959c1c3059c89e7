// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/emulator/image.hpp"

#include <elf.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "holdfast/base/check.hpp"

namespace holdfast::emulator {
namespace {

base::Error fault(const std::string& message) {
  return {.code = base::ErrorCode::kBadInput, .message = message};
}

/// The value at a place of the file; zeros behind its end.
template <class Value>
Value value_at(const std::vector<std::uint8_t>& file, std::size_t place) {
  Value value{};
  if (place <= file.size() && file.size() - place >= sizeof(Value)) {
    std::memcpy(&value, file.data() + place, sizeof(Value));
  }
  return value;
}

bool take_segments(const std::vector<std::uint8_t>& file, const Elf32_Ehdr& header, Image& image) {
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    const auto part = value_at<Elf32_Phdr>(file, header.e_phoff + i * sizeof(Elf32_Phdr));
    if (part.p_type != PT_LOAD || part.p_filesz == 0) {
      continue;
    }
    if (part.p_offset > file.size() || file.size() - part.p_offset < part.p_filesz) {
      return false;
    }
    const auto begin = file.begin() + static_cast<std::ptrdiff_t>(part.p_offset);
    image.segments.push_back({.address = part.p_paddr, .bytes = {begin, begin + part.p_filesz}});
    image.flash_bytes += part.p_filesz;
  }
  return !image.segments.empty();
}

bool lies_in(const std::vector<std::uint8_t>& file, const Elf32_Shdr& section) {
  return section.sh_offset <= file.size() && file.size() - section.sh_offset >= section.sh_size;
}

/// Reads the addresses of all symbols. False if a table of them or of their names lies outside the
/// file.
bool take_symbols(const std::vector<std::uint8_t>& file, const Elf32_Ehdr& header, Image& image) {
  for (std::size_t i = 0; i < header.e_shnum; ++i) {
    const auto table = value_at<Elf32_Shdr>(file, header.e_shoff + i * sizeof(Elf32_Shdr));
    if (table.sh_type != SHT_SYMTAB) {
      continue;
    }
    const auto names =
        value_at<Elf32_Shdr>(file, header.e_shoff + table.sh_link * sizeof(Elf32_Shdr));
    if (!lies_in(file, table) || !lies_in(file, names)) {
      return false;
    }
    for (std::size_t k = 0; k < table.sh_size / sizeof(Elf32_Sym); ++k) {
      const auto symbol = value_at<Elf32_Sym>(file, table.sh_offset + k * sizeof(Elf32_Sym));
      std::string name;
      for (std::size_t at = names.sh_offset + symbol.st_name; at < file.size() && file[at] != 0;
           ++at) {
        name += static_cast<char>(file[at]);
      }
      // The lowest bit of a function says that it is Thumb code.
      const bool is_code = ELF32_ST_TYPE(symbol.st_info) == STT_FUNC;
      image.symbols[name] = is_code ? symbol.st_value & ~1U : symbol.st_value;
    }
  }
  return true;
}

}  // namespace

std::uint32_t Image::at(const std::string& symbol) const {
  const auto found = symbols.find(symbol);
  HOLDFAST_CHECK(found != symbols.end());
  return found->second;
}

/// The configuration lies at the end.
std::uint32_t Image::flash_end() const {
  constexpr std::uint32_t kEnd = 4096;
  return (at("holdfast_configuration") | (kEnd - 1)) + 1;
}

std::uint32_t Image::word(const std::string& symbol) const {
  const std::uint32_t address = at(symbol);
  for (const Segment& segment : segments) {
    if (address >= segment.address && address - segment.address < segment.bytes.size()) {
      return value_at<std::uint32_t>(segment.bytes, address - segment.address);
    }
  }
  return 0;
}

base::Result<Image> load_image(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    return base::Error{.code = base::ErrorCode::kUnreadable,
                       .message = "the firmware image cannot be read"};
  }
  const std::vector<std::uint8_t> file{std::istreambuf_iterator<char>(stream), {}};
  const auto header = value_at<Elf32_Ehdr>(file, 0);
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS32 ||
      header.e_ident[EI_DATA] != ELFDATA2LSB || header.e_machine != EM_ARM) {
    return fault("is no ELF file for a 32-bit Arm, little-endian");
  }
  Image image;
  if (!take_segments(file, header, image)) {
    return fault("is damaged: a segment lies outside the file");
  }
  if (!take_symbols(file, header, image)) {
    return fault("is damaged: a table of symbols lies outside the file");
  }
  for (const char* name :
       {"holdfast_status", "holdfast_stop", "holdfast_stack_begin", "holdfast_stack_end",
        "holdfast_configuration", "holdfast_vectors", "holdfast_agent_bytes",
        "_ZN8holdfast5agent5Agent9step_partERKNS0_5EventERNS0_7ActionsE"}) {
    if (!image.symbols.contains(name)) {
      return fault(std::string("is no firmware of holdfast: it has no symbol ") + name);
    }
  }
  image.ram_bytes = image.at("holdfast_stack_begin") - 0x200000C0U;
  return image;
}

}  // namespace holdfast::emulator
