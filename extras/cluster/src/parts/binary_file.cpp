// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "parts/binary_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <span>
#include <string_view>

#include "holdfast/base/algebra.hpp"
#include "holdfast/holdfast.hpp"
#include "parts/morton_split.hpp"

namespace holdfast::cluster {
namespace {

using base::at;

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
    return host::all(ranks_, read(begin, bytes, MPI_File_read_at_all));
  }

  /// Reads what this rank asks for, whatever the others do.
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
                                               const io::BinaryHead& head,
                                               const base::Lattice& lattice) {
  const base::Cell low = head.low_corner();
  const solver::Bricks bricks(lattice);
  const std::uint64_t begin = head.records_begin();
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
    return base::bad_input("the modules could not be read", fmt::format("byte {}", begin));
  }
  const std::int64_t before = first == 0 ? -1 : static_cast<std::int64_t>(key(first - 1));
  const std::string fault =
      first_message(ranks, io::find_record_fault(records, first, lattice, low, before));
  if (!fault.empty()) {
    return base::bad_input(fault, "");
  }
  if (auto sum_fault =
          io::find_sum_fault(head, sum_of_ranks(ranks, io::record_sum(records, first)))) {
    return *std::move(sum_fault);
  }
  return records;
}

}  // namespace

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
    std::array<char, io::kBinaryMagic.size()> magic{};
    std::ifstream(file, std::ios::binary).read(magic.data(), magic.size());
    is_binary = std::string_view(magic.data(), magic.size()) == io::kBinaryMagic;
  }
  return host::any(ranks, is_binary);
}

base::Result<std::pair<SharedText, std::vector<Record>>> read_binary_file(
    PetscRanks& ranks, const std::string& path, const io::ReadOptions& options) {
  SharedFile file(ranks, path);
  if (!host::all(ranks, file.is_open())) {
    return base::Error{.code = base::ErrorCode::kUnreadable, .message = "cannot be opened"};
  }
  const std::uint64_t size = file.size();
  std::string begin(std::min<std::uint64_t>(size, sizeof(io::BinaryHead)), '\0');
  if (!file.read_all(0, std::as_writable_bytes(std::span(begin)))) {
    return base::bad_input("the head could not be read", "byte 0");
  }
  const auto read_head = io::read_binary_head(begin, size);
  if (!read_head) {
    return read_head.error();
  }
  const io::BinaryHead& head = read_head.value();
  SharedText text;
  text.document.resize(head.text_size);
  if (!file.read_all(sizeof head, std::as_writable_bytes(std::span(text.document)))) {
    return base::bad_input("the text could not be read", fmt::format("byte {}", sizeof head));
  }
  const auto document = io::read_binary_text(head, text.document, options);
  if (!document) {
    return document.error();
  }
  text.low = head.low_corner();
  auto records = read_records(ranks, file, head, document.value().document.extension.lattice);
  if (!records) {
    return records.error();
  }
  return std::pair(std::move(text), std::move(records).value());
}

}  // namespace holdfast::cluster
