// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/result.hpp"
#include "holdfast/io/document.hpp"

/// Binary structures, docs/formats.md: a head, a holdfast JSON text without modules, and the
/// modules along the Morton curve, each 16 bytes. The parts of this file are for programs that read
/// one in pieces; read_document() reads a whole one.
namespace holdfast::io {

/// A module in a file of this format.
struct ModuleRecord {
  static constexpr std::uint32_t kPlanned = 1;
  static constexpr std::uint32_t kFixed = 2;

  std::array<std::int32_t, 3> cell{};
  std::uint32_t flags = 0;

  base::Cell place() const { return {cell[0], cell[1], cell[2]}; }
};

static_assert(sizeof(ModuleRecord) == 16);

/// The first letters of a file.
inline constexpr std::string_view kBinaryMagic = "HOLDFAST";

/// The first bytes of a file.
struct BinaryHead {
  static constexpr std::uint32_t kVersion = 1;

  std::array<char, 8> magic = {'H', 'O', 'L', 'D', 'F', 'A', 'S', 'T'};
  std::uint32_t version = kVersion;
  std::uint32_t record_size = sizeof(ModuleRecord);
  std::uint64_t module_count = 0;
  std::uint64_t text_size = 0;
  std::array<std::int32_t, 3> low{};  ///< The whole robot's lowest corner, in bricks.
  std::uint32_t zero = 0;
  std::uint64_t text_sum = 0;
  std::uint64_t record_sum = 0;
  std::uint64_t head_sum = 0;  ///< Of all bytes before.

  base::Cell low_corner() const { return {low[0], low[1], low[2]}; }

  /// The place where the records begin, at a multiple of 16 bytes.
  std::uint64_t records_begin() const { return (sizeof(BinaryHead) + text_size + 15) / 16 * 16; }
};

static_assert(sizeof(BinaryHead) == 72);

/// The FNV-1a sum of a text, 64 bits.
std::uint64_t text_sum(std::string_view text);

/// A sum that can be made in parts: of a hash of each record and its number in the whole structure,
/// which of the first one here is `first`.
std::uint64_t record_sum(std::span<const ModuleRecord> records, std::uint64_t first);

/// The head of a file of so many bytes, of which `begin` are the first ones.
base::Result<BinaryHead> read_binary_head(std::string_view begin, std::uint64_t file_size);

/// The document of the text behind a head: all but modules. Errors: another checksum; those of
/// read_json(); it has steps.
base::Result<ReadDocument> read_binary_text(const BinaryHead& head, std::string_view text,
                                            const ReadOptions& options = {});

/// Says what is wrong with records, of which the first is number `first` of all; empty if nothing
/// is. `before` is the key of the record before them, -1 if there is none.
std::string find_record_fault(std::span<const ModuleRecord> records, std::uint64_t first,
                              const base::Lattice& lattice, const base::Cell& low,
                              std::int64_t before);

/// Returns an error if the sum of all records is wrong.
std::optional<base::Error> find_sum_fault(const BinaryHead& head, std::uint64_t record_sum);

/// A structure as it stands in a file.
struct BinaryStructure {
  base::Cell low;
  std::string text;                   ///< All but modules.
  std::vector<ModuleRecord> records;  ///< Along the curve.
};

/// The first planned step of a document and what exists. Errors: those of make_spec(); two modules
/// in one cell.
base::Result<BinaryStructure> make_binary(const Document& document);

/// The text of a binary structure: all that a document says beside its modules.
std::string common_text(const Document& document);

/// The bytes of a binary structure before the records.
std::string binary_beginning(const base::Cell& low, const std::string& text,
                             std::uint64_t module_count, std::uint64_t record_sum);

void write_binary(std::ostream& out, const BinaryStructure& structure);

/// Lists what a document has that a binary structure has no room for; empty if nothing.
std::vector<std::string> lost_in_binary(const Document& document);

/// Reads a binary structure; Error::where is the byte, or a place in the text.
base::Result<ReadDocument> read_binary(std::string_view bytes, const ReadOptions& options = {});

}  // namespace holdfast::io
