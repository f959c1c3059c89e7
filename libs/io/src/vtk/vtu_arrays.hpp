// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/host/team.hpp"
#include "holdfast/io/write_options.hpp"

/// The arrays of a VTK XML file in its form "appended raw": one behind the other at the end of the
/// file, in blocks that are compressed one by one with zlib's format. Each begins with a header of
/// UInt64: how many blocks, their size, that of the last if it is smaller (else 0), and the
/// compressed size of each. The page has no compression: there an array is its size and its bytes.
namespace holdfast::io {

/// The content of one array. Values are little-endian on every machine that we build for.
struct VtuArray {
  const char* type = "Float64";
  const char* name = "";
  std::size_t components = 1;
  std::size_t value_bytes = sizeof(double);
  std::size_t tuple_count = 0;
  /// Appends the bytes of the tuples [begin, end); called by several threads at once.
  std::function<void(std::size_t begin, std::size_t end, std::string& out)> append;

  std::size_t tuple_bytes() const { return components * value_bytes; }

  std::size_t bytes() const { return tuple_count * tuple_bytes(); }
};

/// Writes a file's arrays: all are announced in its XML first, then their bytes follow in the same
/// order. Offsets and sizes that are known only then are put into their places at the end, so the
/// stream must be one that can be sought in.
class VtuArrays {
 public:
  VtuArrays(std::ostream& out, const WriteOptions& options);

  /// The attribute of <VTKFile> that says how arrays are compressed; empty if they are not.
  static std::string_view compressor();

  /// Makes announce() describe arrays only, in the element <PDataArray>.
  void list_only() { is_list_ = true; }

  /// Writes the element <DataArray>.
  void announce(VtuArray array);

  /// Writes the element <AppendedData> with all arrays.
  void write();

 private:
  /// Bytes that are put over others at the end.
  struct Patch {
    std::streamoff at = 0;
    std::string bytes;
  };

  struct Announced {
    VtuArray array;
    std::streamoff offset_at = 0;  ///< Where its offset belongs.
  };

  void write_array(const VtuArray& array);
  void write_blocks(const VtuArray& array, std::size_t block_count);

  std::ostream& out_;
  const WriteOptions& options_;
  host::Team team_;
  std::vector<Announced> arrays_;
  std::vector<Patch> patches_;
  bool is_list_ = false;
  std::size_t bytes_all_ = 0;
  std::size_t bytes_done_ = 0;
};

}  // namespace holdfast::io
