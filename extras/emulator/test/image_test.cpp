// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The reader of images against files that are made here field by field, after the ELF
// specification (Tool Interface Standard, version 1.2): what is whole is read, what is broken is
// refused with a sentence that says so.
#include "holdfast/emulator/image.hpp"

#include <elf.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

namespace holdfast::emulator {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kFlash = 0x08000000;
constexpr std::uint32_t kSegmentBytes = 16;
/// The vectors have the first 192 bytes of RAM; data lie behind them.
constexpr std::uint32_t kDataBegin = 0x200000C0;

const std::vector<std::string>& symbol_names() {
  static const std::vector<std::string> names = {
      "holdfast_status",        "holdfast_stop",
      "holdfast_stack_begin",   "holdfast_stack_end",
      "holdfast_configuration", "holdfast_vectors",
      "holdfast_agent_bytes",   "_ZN8holdfast5agent5Agent9step_partERKNS0_5EventERNS0_7ActionsE"};
  return names;
}

/// An image in parts: header, one segment's entry, its bytes 0 to 15, two sections' entries,
/// symbols, names.
struct Parts {
  Elf32_Ehdr header{};
  Elf32_Phdr segment{};
  Bytes content;
  std::array<Elf32_Shdr, 2> sections{};
  std::vector<Elf32_Sym> symbols;
  std::string names;

  explicit Parts(const std::vector<std::string>& wanted = symbol_names()) {
    for (std::uint8_t i = 0; i < kSegmentBytes; ++i) {
      content.push_back(i);
    }
    std::uint32_t value = 0;
    for (const std::string& name : wanted) {
      const bool is_code = name.starts_with("_Z");
      symbols.push_back({.st_name = static_cast<Elf32_Word>(names.size()),
                         .st_value = name == "holdfast_stack_begin" ? kDataBegin + 1000
                                     : is_code                      ? kFlash + 9
                                                                    : kFlash + value,
                         .st_size = 4,
                         .st_info = static_cast<unsigned char>(
                             ELF32_ST_INFO(STB_GLOBAL, is_code ? STT_FUNC : STT_OBJECT)),
                         .st_other = 0,
                         .st_shndx = 1});
      names += name + '\0';
      value += 2;
    }
    fill();
  }

  std::uint32_t symbols_at() const {
    return sizeof(header) + sizeof(segment) + kSegmentBytes + sizeof(sections);
  }

  void fill() {
    std::memcpy(header.e_ident, ELFMAG, SELFMAG);
    header.e_ident[EI_CLASS] = ELFCLASS32;
    header.e_ident[EI_DATA] = ELFDATA2LSB;
    header.e_machine = EM_ARM;
    header.e_phoff = sizeof(header);
    header.e_phnum = 1;
    header.e_shoff = sizeof(header) + sizeof(segment) + kSegmentBytes;
    header.e_shnum = 2;
    segment.p_type = PT_LOAD;
    segment.p_offset = sizeof(header) + sizeof(segment);
    segment.p_paddr = kFlash;
    segment.p_filesz = kSegmentBytes;
    const auto symbol_bytes = static_cast<Elf32_Word>(symbols.size() * sizeof(Elf32_Sym));
    sections[0].sh_type = SHT_SYMTAB;
    sections[0].sh_offset = symbols_at();
    sections[0].sh_size = symbol_bytes;
    sections[0].sh_link = 1;
    sections[1].sh_type = SHT_STRTAB;
    sections[1].sh_offset = symbols_at() + symbol_bytes;
    sections[1].sh_size = static_cast<Elf32_Word>(names.size());
  }

  Bytes file() const {
    Bytes bytes;
    const auto add = [&](const void* data, std::size_t size) {
      const auto* begin = static_cast<const std::uint8_t*>(data);
      bytes.insert(bytes.end(), begin, begin + size);
    };
    add(&header, sizeof(header));
    add(&segment, sizeof(segment));
    add(content.data(), content.size());
    add(sections.data(), sizeof(sections));
    add(symbols.data(), symbols.size() * sizeof(Elf32_Sym));
    add(names.data(), names.size());
    return bytes;
  }
};

class ImageTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "image_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }

  void TearDown() override { std::filesystem::remove_all(folder_); }

  base::Result<Image> load(const Bytes& bytes) const {
    const std::string path = (folder_ / "image.elf").string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return load_image(path);
  }

  void expect_refused(const Bytes& bytes, const std::string& why) const {
    const auto image = load(bytes);
    ASSERT_FALSE(image) << why;
    EXPECT_EQ(image.error().code, base::ErrorCode::kBadInput);
    EXPECT_NE(image.error().message.find(why), std::string::npos) << image.error().message;
  }

  std::filesystem::path folder_;
};

TEST_F(ImageTest, that_is_whole_is_read) {
  const auto loaded = load(Parts().file());
  ASSERT_TRUE(loaded) << loaded.error().message;
  const Image& image = loaded.value();
  ASSERT_EQ(image.segments.size(), 1U);
  EXPECT_EQ(image.segments[0].address, kFlash);
  EXPECT_EQ(image.segments[0].bytes, Parts().content);
  EXPECT_EQ(image.flash_bytes, kSegmentBytes);
  EXPECT_EQ(image.ram_bytes, 1000U);
  EXPECT_EQ(image.at("holdfast_configuration"), kFlash + 8);
  EXPECT_EQ(image.word("holdfast_configuration"), 0x0b0a0908U) << "little-endian";
  EXPECT_EQ(image.word("holdfast_stack_begin"), 0U) << "not in flash";
  EXPECT_EQ(image.at(symbol_names().back()), kFlash + 8) << "without the bit for Thumb code";
}

TEST_F(ImageTest, that_is_not_there_is_refused) {
  const auto image = load_image((folder_ / "missing.elf").string());
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, base::ErrorCode::kUnreadable);
  EXPECT_EQ(image.error().message, "the firmware image cannot be read");
}

TEST_F(ImageTest, for_another_machine_is_refused) {
  const std::string why = "is no ELF file for a 32-bit Arm";
  expect_refused({}, why);
  expect_refused({'#', '!', '/', 'b', 'i', 'n'}, why);
  Parts wide;
  wide.header.e_ident[EI_CLASS] = ELFCLASS64;
  expect_refused(wide.file(), why);
  Parts big;
  big.header.e_ident[EI_DATA] = ELFDATA2MSB;
  expect_refused(big.file(), why);
  Parts other;
  other.header.e_machine = EM_AVR;
  expect_refused(other.file(), why);
}

TEST_F(ImageTest, with_a_segment_outside_the_file_is_refused) {
  const std::string why = "a segment lies outside the file";
  for (const std::uint32_t offset : {0x1000'0000U, 0xffff'ffffU}) {
    Parts parts;
    parts.segment.p_offset = offset;
    expect_refused(parts.file(), why);
  }
  for (const std::uint32_t size : {0x1000'0000U, 0xffff'ffffU}) {
    Parts parts;
    parts.segment.p_filesz = size;
    expect_refused(parts.file(), why);
  }
}

TEST_F(ImageTest, with_symbols_outside_the_file_is_refused) {
  const std::string why = "a table of symbols lies outside the file";
  for (const std::size_t section : {0U, 1U}) {
    for (const std::uint32_t number : {0x1000'0000U, 0xffff'ffffU}) {
      Parts far;
      far.sections.at(section).sh_offset = number;
      expect_refused(far.file(), why);
      Parts large;
      large.sections.at(section).sh_size = number;
      expect_refused(large.file(), why);
    }
  }
}

TEST_F(ImageTest, of_another_program_is_refused_by_the_symbol_that_it_lacks) {
  for (const std::string& name : symbol_names()) {
    std::vector<std::string> others = symbol_names();
    std::erase(others, name);
    expect_refused(Parts(others).file(), "it has no symbol " + name);
  }
}

/// The names stand last, so whatever is cut off is missing.
TEST_F(ImageTest, that_was_cut_off_anywhere_is_refused) {
  const Bytes whole = Parts().file();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto image = load({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    ASSERT_FALSE(image) << size << " of " << whole.size();
    EXPECT_TRUE(image.error().message.starts_with("is ")) << image.error().message;
  }
}

/// One byte is another one: the file is read or refused, and nothing else happens.
TEST_F(ImageTest, with_any_byte_changed_is_read_or_refused) {
  const Bytes whole = Parts().file();
  std::mt19937_64 random(5);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    Bytes changed = whole;
    changed[i] = static_cast<std::uint8_t>(changed[i] ^ (1 + random() % 255));
    const auto image = load(changed);
    EXPECT_TRUE(image || !image.error().message.empty());
  }
}

}  // namespace
}  // namespace holdfast::emulator
