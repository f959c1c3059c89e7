// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "vtk/vtu_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "binary/compressed_block.hpp"
#include "ordered_blocks.hpp"

namespace holdfast::io {
namespace {

static_assert(std::endian::native == std::endian::little);

/// The size of a block before it is compressed: a window of them takes a few megabytes. A multiple
/// of all tuples, which have 1, 4, 8, 12 or 24 bytes.
constexpr std::size_t kBlockBytes = std::size_t{192} * 1024;

/// Digits of the largest offset.
constexpr std::size_t kOffsetWidth = 20;

void append_count(std::string& out, std::uint64_t count) {
  const auto bytes = std::bit_cast<std::array<char, sizeof count>>(count);
  out.append(bytes.data(), bytes.size());
}

}  // namespace

VtuArrays::VtuArrays(std::ostream& out, const WriteOptions& options)
    : out_(out), options_(options), team_(options.thread_count) {}

std::string_view VtuArrays::compressor() {
  return kCompresses ? " compressor=\"vtkZLibDataCompressor\"" : "";
}

void VtuArrays::announce(VtuArray array) {
  if (is_list_) {
    out_ << fmt::format("<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n",
                        array.type, array.name, array.components);
    return;
  }
  out_ << fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=",
      array.type, array.name, array.components);
  const std::streamoff offset_at = out_.tellp();
  out_ << std::string(kOffsetWidth + 2, ' ') << "/>\n";
  bytes_all_ += array.bytes();
  arrays_.push_back({.array = std::move(array), .offset_at = offset_at});
}

void VtuArrays::write() {
  out_ << "<AppendedData encoding=\"raw\">\n_";
  const std::streamoff begin = out_.tellp();
  for (const Announced& announced : arrays_) {
    const std::streamoff offset = out_.tellp() - begin;
    patches_.push_back({.at = announced.offset_at, .bytes = fmt::format("\"{}\"", offset)});
    write_array(announced.array);
    if (!out_) {
      return;
    }
  }
  out_ << "\n</AppendedData>\n";
  const std::streamoff end = out_.tellp();
  for (const Patch& patch : patches_) {
    out_.seekp(patch.at);
    out_ << patch.bytes;
  }
  out_.seekp(end);
}

void VtuArrays::write_array(const VtuArray& array) {
  const std::size_t block_count = (array.bytes() + kBlockBytes - 1) / kBlockBytes;
  std::string header;
  if constexpr (kCompresses) {
    append_count(header, block_count);
    append_count(header, kBlockBytes);
    append_count(header, array.bytes() % kBlockBytes);
    out_ << header;
    const std::streamoff sizes_at = out_.tellp();
    out_ << std::string(block_count * sizeof(std::uint64_t), '\0');
    patches_.push_back({.at = sizes_at, .bytes = {}});
  } else {
    append_count(header, array.bytes());
    out_ << header;
  }
  write_blocks(array, block_count);
}

void VtuArrays::write_blocks(const VtuArray& array, std::size_t block_count) {
  const std::size_t block_tuples = kBlockBytes / array.tuple_bytes();
  for_ordered_blocks(
      team_, block_count,
      [&](std::size_t block, std::string& bytes) {
        const std::size_t begin = block * block_tuples;
        array.append(begin, std::min(begin + block_tuples, array.tuple_count), bytes);
        if constexpr (kCompresses) {
          bytes = compressed(bytes);
        }
      },
      [&](const std::string& bytes) {
        if constexpr (kCompresses) {
          append_count(patches_.back().bytes, bytes.size());
        }
        out_ << bytes;
        bytes_done_ += std::min(kBlockBytes, bytes_all_ - bytes_done_);
        if (options_.progress) {
          options_.progress(static_cast<double>(bytes_done_) / static_cast<double>(bytes_all_));
        }
        return out_.good();
      });
}

}  // namespace holdfast::io
