// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/wire/wire.hpp"
#include "holdfast/base/cell.hpp"

/// Messages, field by field.
///
/// Every message lists its fields once, in a function `fields(codec, message)`. A Codec writes them
/// or reads them, as it was made; a Ruler adds up their bytes. What a field may be stands in that
/// list, too, and reading looks: is_legal() says in the end whether all was as it must be.
namespace holdfast::agent::wire {

class Codec {
 public:
  /// Writes.
  explicit Codec(Writer& out) : out_(&out), in_({}) {}

  /// Reads from an offset on.
  Codec(std::span<const std::uint8_t> message, std::size_t at) : in_(message, at) {}

  /// Reads messages of modules with so many faces; else of cubes.
  void set_face_count(int count) { face_count_ = count; }

  /// Is false once a field was read that no program of this version writes.
  bool is_legal() const { return is_legal_; }

  /// A number from `first` to `last`.
  void u8(std::uint8_t& value, std::uint8_t first = 0, std::uint8_t last = 0xff);
  void u16(std::uint16_t& value, std::uint16_t first = 0, std::uint16_t last = 0xffff);
  /// No other bits than those of `all`.
  void flags(std::uint8_t& value, std::uint8_t all);
  /// Faces of a module, in 16 bits as some lattices have 12 directions.
  void faces(FaceMask& mask);
  /// A part of the masks of planned modules in kResume (resume_masks.hpp).
  void resumed_faces(std::uint8_t& byte);
  void direction(base::Direction& direction);
  /// A direction in one byte with remarks above it, no others than those of `all`.
  void direction(base::Direction& direction, std::uint8_t& remarks, std::uint8_t all);
  /// The cell of a module, and of a plan: that, or kEveryCell.
  void cell(base::Cell& cell);
  void place(base::Cell& cell);

  /// An enumerator from the first to the last one.
  template <class Kind>
  void kind(Kind& value, Kind first, Kind last) {
    auto byte = static_cast<std::uint8_t>(value);
    u8(byte, static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(last));
    value = static_cast<Kind>(byte);
  }

  /// A first moment, in 64 bits: at most kMomentMost either way, or what has 32 bits here.
  void moment(std::int64_t& value);
  void moment(std::int32_t& value);

  // These may be anything.
  void u32(std::uint32_t& value);
  void i32(std::int32_t& value);
  void real(float& value);
  void long_real(double& value);
  void half_cells(base::Cell& corner);

  void require(bool holds) { is_legal_ = is_legal_ && holds; }

 private:
  int face_count() const { return kIsGeneral ? int{face_count_} : kOwnFaceCount; }

  Writer* out_ = nullptr;
  Reader in_;
  bool is_legal_ = true;
  [[no_unique_address]] PresentIf<kIsGeneral, int> face_count_ = kOwnFaceCount;
};

/// Measures a message without touching it.
class Ruler {
 public:
  constexpr explicit Ruler(int bytes) : bytes_(bytes) {}

  constexpr int bytes() const { return bytes_; }

  constexpr void u8(std::uint8_t&, unsigned = 0, unsigned = 0) { bytes_ += 1; }

  constexpr void u16(std::uint16_t&, unsigned = 0, unsigned = 0) { bytes_ += 2; }

  constexpr void flags(std::uint8_t&, unsigned) { bytes_ += 1; }

  constexpr void faces(FaceMask&) { bytes_ += 2; }

  constexpr void resumed_faces(std::uint8_t&) { bytes_ += 1; }

  constexpr void direction(base::Direction&) { bytes_ += 1; }

  constexpr void direction(base::Direction&, std::uint8_t&, unsigned) { bytes_ += 1; }

  constexpr void moment(std::int64_t&) { bytes_ += 8; }

  constexpr void moment(std::int32_t&) { bytes_ += 8; }

  constexpr void cell(base::Cell&) { bytes_ += kCellBytes; }

  constexpr void place(base::Cell&) { bytes_ += kCellBytes; }

  template <class Kind>
  constexpr void kind(Kind&, Kind, Kind) {
    bytes_ += 1;
  }

  constexpr void u32(std::uint32_t&) { bytes_ += 4; }

  constexpr void i32(std::int32_t&) { bytes_ += 4; }

  constexpr void real(float&) { bytes_ += 4; }

  constexpr void long_real(double&) { bytes_ += 8; }

  constexpr void half_cells(base::Cell&) { bytes_ += kCellBytes; }

  constexpr void require(bool) {}

 private:
  int bytes_;
};

}  // namespace holdfast::agent::wire
