// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "parts/generator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/model/families.hpp"
#include "parts/binary_file.hpp"
#include "parts/structure.hpp"

namespace holdfast::cluster {
namespace {

using base::at;
using base::Cell;
using model::CellBox;

/// Keys have 21 bits for each coordinate.
constexpr std::int32_t kExtentMax = 1 << 21;

/// Records that are written at once.
constexpr std::size_t kChunk = 65536;

/// Blocks of the curve for each rank, so that ranks have about as much to do.
constexpr std::size_t kBlocksPerRank = 64;

/// Calls f(corner) along the Morton curve for the cubes of 2^bottom cells within one of 2^level
/// that reach into the box. Those that may_have(corner, level) denies are passed by.
template <class Test, class F>
void walk(const CellBox& box, const Cell& corner, int level, int bottom, const Test& may_have,
          const F& f) {
  if (corner.x >= box.high.x || corner.y >= box.high.y || corner.z >= box.high.z ||
      !may_have(corner, level)) {
    return;
  }
  if (level == bottom) {
    f(corner);
    return;
  }
  const std::int32_t half = 1 << (level - 1);
  for (int octant = 0; octant < 8; ++octant) {
    walk(box,
         {corner.x + half * (octant & 1), corner.y + half * (octant >> 1 & 1),
          corner.z + half * (octant >> 2 & 1)},
         level - 1, bottom, may_have, f);
  }
}

/// A family and a size that can be made in parts, or what is wrong with them.
struct Wanted {
  const model::FamilyInfo* info = nullptr;
  std::size_t size = 0;
  CellBox box;
};

/// Whether a cube of 2^level cells may hold any.
auto may_have(const Wanted& wanted) {
  return [&wanted](const Cell& corner, int level) {
    const std::int32_t side = 1 << level;
    return model::family_may_have(wanted.info->family, wanted.size,
                                  {corner, {corner.x + side, corner.y + side, corner.z + side}});
  };
}

/// A rank's part of the curve: cubes of 2^level cells.
struct Blocks {
  std::vector<Cell> corners;
  int level = 0;
};

Blocks blocks_of_rank(const PetscRanks& ranks, const Wanted& wanted) {
  const CellBox& box = wanted.box;
  const std::int32_t extent =
      std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
  const int top = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(extent - 1)));
  Blocks blocks{.corners = {}, .level = top + 1};
  std::vector<Cell> all;
  while (blocks.level > 0 && all.size() < kBlocksPerRank * at(ranks.count())) {
    --blocks.level;
    all.clear();
    walk(wanted.box, wanted.box.low, top, blocks.level, may_have(wanted),
         [&](const Cell& corner) { all.push_back(corner); });
  }
  const auto bound = [&](int rank) {
    return all.begin() + static_cast<std::ptrdiff_t>(all.size() * at(rank) / at(ranks.count()));
  };
  blocks.corners.assign(bound(ranks.rank()), bound(ranks.rank() + 1));
  return blocks;
}

/// A file that all ranks write at once. Until finish() it has another name.
class SharedOutput {
 public:
  SharedOutput(PetscRanks& ranks, std::string path)
      : ranks_(ranks), path_(std::move(path)), unfinished_(path_ + ".unfinished") {
    is_good_ = MPI_File_open(ranks.comm(), unfinished_.c_str(), MPI_MODE_CREATE | MPI_MODE_WRONLY,
                             MPI_INFO_NULL, &file_) == MPI_SUCCESS;
    is_open_ = is_good_;
    is_good_ = host::all(ranks_, is_good_) && MPI_File_set_size(file_, 0) == MPI_SUCCESS;
  }

  SharedOutput(const SharedOutput&) = delete;
  SharedOutput& operator=(const SharedOutput&) = delete;

  ~SharedOutput() {
    if (is_open_) {
      MPI_File_close(&file_);
      if (ranks_.rank() == 0) {
        std::remove(unfinished_.c_str());
      }
    }
  }

  bool is_good() const { return is_good_; }

  void write(std::uint64_t begin, std::span<const std::byte> bytes) {
    MPI_Status status;
    int count = 0;
    is_good_ = is_good_ &&
               MPI_File_write_at(file_, static_cast<MPI_Offset>(begin), bytes.data(),
                                 static_cast<int>(bytes.size()), MPI_BYTE, &status) == MPI_SUCCESS;
    if (is_good_) {
      MPI_Get_count(&status, MPI_BYTE, &count);
      is_good_ = count == static_cast<int>(bytes.size());
    }
  }

  /// Whether all ranks have written all and the file is in its place.
  bool finish() {
    is_good_ = host::all(ranks_, is_good_);
    if (!is_good_) {
      return false;
    }
    is_open_ = false;
    is_good_ = MPI_File_close(&file_) == MPI_SUCCESS;
    if (ranks_.rank() == 0) {
      is_good_ = is_good_ && std::rename(unfinished_.c_str(), path_.c_str()) == 0;
    }
    return host::all(ranks_, is_good_);
  }

 private:
  PetscRanks& ranks_;
  std::string path_;
  std::string unfinished_;
  MPI_File file_ = MPI_FILE_NULL;
  bool is_open_ = false;
  bool is_good_ = false;
};

base::Result<Wanted> find_wanted(const std::string& family, std::size_t size) {
  const auto families = model::families();
  const auto found = std::ranges::find(families, family, &model::FamilyInfo::name);
  if (found == families.end()) {
    return base::bad_input(fmt::format("no family '{}'", family));
  }
  if (size < found->size_min || size > at(kExtentMax)) {
    return base::bad_input(fmt::format("the size {} is not allowed for {}: it is {} to {}", size,
                                       family, found->size_min, kExtentMax));
  }
  const auto box = model::family_box(found->family, size);
  if (!box || found->lattice != base::kCubic) {
    return base::bad_input(fmt::format(
        "the family {} cannot be made in parts: write it by holdfast generate, then convert it",
        family));
  }
  return Wanted{.info = &*found, .size = size, .box = *box};
}

/// Calls f with the records of this rank, in chunks.
template <class F>
void for_chunks(const Wanted& wanted, const Blocks& blocks, const F& f) {
  std::vector<Record> chunk;
  for (const Cell& block : blocks.corners) {
    walk(wanted.box, block, blocks.level, 0, may_have(wanted), [&](const Cell& cell) {
      if (!model::family_has(wanted.info->family, wanted.size, cell)) {
        return;
      }
      chunk.push_back({.cell = {cell.x, cell.y, cell.z}});
      if (chunk.size() == kChunk) {
        f(std::span<const Record>(chunk));
        chunk.clear();
      }
    });
  }
  f(std::span<const Record>(chunk));
}

std::string text_of(const Wanted& wanted) {
  io::Document document;
  document.name = fmt::format("{} {}", wanted.info->name, wanted.size);
  document.description = wanted.info->help;
  document.modules.emplace_back().cell = wanted.box.low;
  return io::common_text(document);
}

}  // namespace

base::Result<std::uint64_t> generate_in_parts(PetscRanks& ranks, const std::string& family,
                                              std::size_t size, const std::string& file) {
  const auto wanted = find_wanted(family, size);
  if (!wanted) {
    return wanted.error();
  }
  const Blocks blocks = blocks_of_rank(ranks, wanted.value());
  std::size_t count = 0;
  for_chunks(wanted.value(), blocks, [&](std::span<const Record> chunk) { count += chunk.size(); });
  const std::vector<std::size_t> starts = host::starts(ranks, count);
  const std::string text = text_of(wanted.value());
  const Cell& low = wanted.value().box.low;
  const std::size_t records_begin = io::binary_beginning(low, text, 0, 0).size();
  SharedOutput output(ranks, file);
  std::uint64_t sum = 0;
  std::uint64_t next = starts[at(ranks.rank())];
  if (output.is_good()) {
    for_chunks(wanted.value(), blocks, [&](std::span<const Record> chunk) {
      output.write(records_begin + sizeof(Record) * next, std::as_bytes(chunk));
      sum += io::record_sum(chunk, next);
      next += chunk.size();
    });
  }
  sum = sum_of_ranks(ranks, sum);
  if (output.is_good() && ranks.rank() == 0) {
    const std::string beginning = io::binary_beginning(low, text, starts.back(), sum);
    output.write(0, std::as_bytes(std::span(beginning)));
  }
  if (!output.finish()) {
    return base::Error{.code = base::ErrorCode::kUnwritable, .message = "cannot be written"};
  }
  return starts.back();
}

}  // namespace holdfast::cluster
