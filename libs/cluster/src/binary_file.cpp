// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "binary_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>

#include "holdfast/base/algebra.hpp"
#include "holdfast/holdfast.hpp"
#include "morton_split.hpp"

namespace holdfast::cluster {
namespace {

using base::at;

static_assert(std::endian::native == std::endian::little, "the format is little-endian");
static_assert(sizeof(Record) == 16);

constexpr std::array<char, 8> kMagic = {'H', 'O', 'L', 'D', 'F', 'A', 'S', 'T'};
constexpr std::uint32_t kVersion = 1;

/// The first bytes of a file.
struct Head {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t record_size = sizeof(Record);
  std::uint64_t module_count = 0;
  std::uint64_t text_size = 0;
  std::array<std::int32_t, 3> low{};
  std::uint32_t zero = 0;
  std::uint64_t text_sum = 0;
  std::uint64_t record_sum = 0;
  std::uint64_t head_sum = 0;  ///< Of all bytes before.
};

static_assert(sizeof(Head) == 72);

constexpr std::uint64_t kTextSizeMax = std::uint64_t{1} << 30U;

/// Beyond this the file is not what it seems.
constexpr std::uint64_t kModuleCountMax = std::uint64_t{1} << 40U;

/// FNV-1a, 64 bits.
std::uint64_t sum_of(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::byte byte : bytes) {
    hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3U;
  }
  return hash;
}

std::uint64_t sum_of(const Head& head) {
  return sum_of(std::as_bytes(std::span(&head, 1)).first(offsetof(Head, head_sum)));
}

/// splitmix64's mixing.
std::uint64_t mixed(std::uint64_t word) {
  word = (word ^ word >> 30U) * 0xbf58476d1ce4e5b9U;
  word = (word ^ word >> 27U) * 0x94d049bb133111ebU;
  return word ^ word >> 31U;
}

/// Where the records begin: at a multiple of 16 bytes.
std::uint64_t records_begin(const Head& head) {
  return (sizeof(Head) + head.text_size + 15) / 16 * 16;
}

base::Error bad_input(std::string message, std::string where) {
  return {
      .code = base::ErrorCode::kBadInput, .message = std::move(message), .where = std::move(where)};
}

/// A file that all ranks have open.
class SharedFile {
 public:
  SharedFile(PetscRanks& ranks, const std::string& path) : ranks_(ranks) {
    is_open_ = MPI_File_open(ranks.comm(), path.c_str(), MPI_MODE_RDONLY, MPI_INFO_NULL, &file_) ==
               MPI_SUCCESS;
  }

  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  ~SharedFile() {
    if (is_open_) {
      MPI_File_close(&file_);
    }
  }

  bool is_open() const { return is_open_; }

  std::uint64_t size() const {
    MPI_Offset bytes = 0;
    MPI_File_get_size(file_, &bytes);
    return static_cast<std::uint64_t>(bytes);
  }

  /// Reads what this rank asks for, all ranks at once. Returns whether all have got it all.
  bool read_all(std::uint64_t begin, std::span<std::byte> bytes) {
    return host::all(&ranks_, read(begin, bytes, MPI_File_read_at_all));
  }

  /// The same by this rank alone.
  bool read_alone(std::uint64_t begin, std::span<std::byte> bytes) {
    return read(begin, bytes, MPI_File_read_at);
  }

 private:
  template <class Read>
  bool read(std::uint64_t begin, std::span<std::byte> bytes, Read read_at) {
    constexpr std::size_t kMax = std::size_t{1} << 30U;
    if (bytes.size() > 2 * kMax - 1) {
      return false;
    }
    MPI_Status status;
    const int count = static_cast<int>(bytes.size());
    int got = 0;
    const bool is_read = read_at(file_, static_cast<MPI_Offset>(begin), bytes.data(), count,
                                 MPI_BYTE, &status) == MPI_SUCCESS;
    MPI_Get_count(&status, MPI_BYTE, &got);
    return is_read && got == count;
  }

  PetscRanks& ranks_;
  MPI_File file_ = MPI_FILE_NULL;
  bool is_open_ = false;
};

std::optional<base::Error> find_fault(const Head& head, std::uint64_t file_size) {
  if (head.magic != kMagic) {
    return bad_input("is no binary structure, expected are the letters HOLDFAST", "byte 0");
  }
  if (head.version != kVersion) {
    return bad_input(fmt::format("version {}, known is {}", head.version, kVersion), "byte 8");
  }
  if (head.head_sum != sum_of(head)) {
    return bad_input("the head's checksum is wrong: the file was changed or damaged", "byte 64");
  }
  if (head.record_size != sizeof(Record) || head.text_size > kTextSizeMax ||
      head.module_count == 0 || head.module_count > kModuleCountMax) {
    return bad_input(fmt::format("{} modules of {} bytes and a text of {} bytes", head.module_count,
                                 head.record_size, head.text_size),
                     "byte 12");
  }
  const std::uint64_t expected = records_begin(head) + sizeof(Record) * head.module_count;
  if (file_size != expected) {
    return bad_input(fmt::format("{} bytes long, expected are {}", file_size, expected),
                     fmt::format("byte {}", std::min(file_size, expected)));
  }
  return std::nullopt;
}

/// What is wrong with a rank's records, of which the first is number `first` of all; empty if
/// nothing is. `before` is the key of the record before them, -1 if there is none.
std::string find_fault(std::span<const Record> records, std::uint64_t first,
                       const solver::Bricks& bricks, const base::Cell& low, std::int64_t before) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& record = records[i];
    const base::Cell brick = bricks.of(record.place());
    const bool is_inside = brick.x >= low.x && brick.y >= low.y && brick.z >= low.z;
    if (!is_inside || record.flags > (Record::kPlanned | Record::kFixed)) {
      return fmt::format("the module {} in the cell {}: {}", first + i, model::text(record.place()),
                         is_inside ? "flags that are not known" : "it lies below the low corner");
    }
    const std::uint64_t key = solver::morton_key(brick, low);
    if (static_cast<std::int64_t>(key) <= before) {
      return fmt::format(
          "the module {} in the cell {}: it is there twice, or not in its place along the curve",
          first + i, model::text(record.place()));
    }
    before = static_cast<std::int64_t>(key);
  }
  return {};
}

/// The first rank's message that is not empty.
std::string first_message(PetscRanks& ranks, const std::string& mine) {
  const double first = -ranks.max(mine.empty() ? -ranks.count() : -ranks.rank());
  const std::string sent = ranks.rank() == first ? mine : std::string();
  const auto all = host::gather(static_cast<host::Ranks&>(ranks),
                                std::span<const char>(sent.data(), sent.size()));
  return {all.begin(), all.end()};
}

/// Reads this rank's range of records, and checks it.
base::Result<std::vector<Record>> read_records(PetscRanks& ranks, SharedFile& file,
                                               const Head& head, const base::Lattice& lattice) {
  const base::Cell low = {head.low[0], head.low[1], head.low[2]};
  const solver::Bricks bricks(lattice);
  const std::uint64_t begin = records_begin(head);
  const auto key = [&](std::size_t i) {
    Record record;
    file.read_alone(begin + sizeof(Record) * i, std::as_writable_bytes(std::span(&record, 1)));
    return solver::morton_key(bricks.of(record.place()), low);
  };
  const auto rank = at(ranks.rank());
  const std::size_t first = split_point(head.module_count, at(ranks.count()), rank, key);
  const std::size_t last = split_point(head.module_count, at(ranks.count()), rank + 1, key);
  std::vector<Record> records(last > first ? last - first : 0);
  if (!file.read_all(begin + sizeof(Record) * first, std::as_writable_bytes(std::span(records)))) {
    return bad_input("the modules could not be read", fmt::format("byte {}", begin));
  }
  const std::int64_t before = first == 0 ? -1 : static_cast<std::int64_t>(key(first - 1));
  const std::string fault = first_message(ranks, find_fault(records, first, bricks, low, before));
  if (!fault.empty()) {
    return bad_input(fault, "");
  }
  if (sum_of_ranks(ranks, record_sum(records, first)) != head.record_sum) {
    return bad_input("the modules' checksum is wrong: the file was changed or damaged", "byte 56");
  }
  return records;
}

}  // namespace

std::uint64_t text_sum(std::string_view text) {
  return sum_of(std::as_bytes(std::span(text.data(), text.size())));
}

std::uint64_t record_sum(std::span<const Record> records, std::uint64_t first) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    std::array<std::uint64_t, 2> words{};
    std::memcpy(words.data(), &records[i], sizeof words);
    sum += mixed(mixed(mixed(first + i + 1) ^ words[0]) ^ words[1]);
  }
  return sum;
}

std::uint64_t sum_of_ranks(PetscRanks& ranks, std::uint64_t mine) {
  std::uint64_t sum = 0;
  for (const std::uint64_t one :
       host::gather(static_cast<host::Ranks&>(ranks), std::span<const std::uint64_t>(&mine, 1))) {
    sum += one;
  }
  return sum;
}

bool is_binary_file(PetscRanks& ranks, const std::string& file) {
  bool is_binary = false;
  if (ranks.rank() == 0 && file != "-") {
    std::array<char, kMagic.size()> magic{};
    std::ifstream(file, std::ios::binary).read(magic.data(), magic.size());
    is_binary = magic == kMagic;
  }
  return host::any(&ranks, is_binary);
}

base::Result<std::pair<SharedText, std::vector<Record>>> read_binary_file(PetscRanks& ranks,
                                                                          const std::string& path) {
  SharedFile file(ranks, path);
  Head head;
  if (!host::all(&ranks, file.is_open())) {
    return base::Error{.code = base::ErrorCode::kUnreadable, .message = "cannot be opened"};
  }
  const std::uint64_t size = file.size();
  if (size < sizeof head || !file.read_all(0, std::as_writable_bytes(std::span(&head, 1)))) {
    return bad_input(fmt::format("{} bytes long, the head alone has {}", size, sizeof head),
                     fmt::format("byte {}", size));
  }
  if (auto fault = find_fault(head, size)) {
    return *fault;
  }
  SharedText text;
  text.document.resize(head.text_size);
  if (!file.read_all(sizeof head, std::as_writable_bytes(std::span(text.document))) ||
      text_sum(text.document) != head.text_sum) {
    return bad_input("the text's checksum is wrong: the file was changed or damaged", "byte 48");
  }
  const auto document = io::read_json(text.document);
  if (!document) {
    return document.error();
  }
  text.low = {head.low[0], head.low[1], head.low[2]};
  auto records = read_records(ranks, file, head, document.value().document.extension.lattice);
  if (!records) {
    return records.error();
  }
  return std::pair(std::move(text), std::move(records).value());
}

std::string binary_beginning(const base::Cell& low, const std::string& text,
                             std::uint64_t module_count, std::uint64_t record_sum) {
  Head head{.module_count = module_count,
            .text_size = text.size(),
            .low = {low.x, low.y, low.z},
            .text_sum = text_sum(text),
            .record_sum = record_sum};
  head.head_sum = sum_of(head);
  std::string bytes(reinterpret_cast<const char*>(&head), sizeof head);
  bytes += text;
  bytes.resize(records_begin(head), '\0');
  return bytes;
}

std::optional<base::Error> write_binary_file(const std::string& file, const base::Cell& low,
                                             const std::string& text,
                                             std::span<const Record> records) {
  return write_file(file, [&](std::ostream& out) {
    out << binary_beginning(low, text, records.size(), record_sum(records, 0));
    out.write(reinterpret_cast<const char*>(records.data()),
              static_cast<std::streamsize>(records.size_bytes()));
  });
}

}  // namespace holdfast::cluster
