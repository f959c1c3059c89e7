// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "messages/codec.hpp"

#include "holdfast/agent/cells/planned_set.hpp"
#include "holdfast/agent/messages/order.hpp"

namespace holdfast::agent::wire {
namespace {

bool is_near(const base::Cell& cell) {
  for (const std::int32_t coordinate : {cell.x, cell.y, cell.z}) {
    if (coordinate < -base::kCoordinateMax || coordinate > base::kCoordinateMax) {
      return false;
    }
  }
  return true;
}

}  // namespace

void Codec::u8(std::uint8_t& value, std::uint8_t first, std::uint8_t last) {
  if (out_ != nullptr) {
    return out_->u8(value);
  }
  value = in_.u8();
  require(value >= first && value <= last);
}

void Codec::u16(std::uint16_t& value, std::uint16_t first, std::uint16_t last) {
  if (out_ != nullptr) {
    return out_->u16(value);
  }
  value = in_.u16();
  require(value >= first && value <= last);
}

void Codec::flags(std::uint8_t& value, std::uint8_t all) {
  u8(value);
  require((value & ~unsigned{all}) == 0);
}

void Codec::faces(FaceMask& mask) {
  std::uint16_t wide = mask;
  u16(wide, 0, Faces::all(face_count()).mask());
  mask = static_cast<FaceMask>(wide);
}

void Codec::resumed_faces(std::uint8_t& byte) {
  constexpr std::uint8_t kAll = 0xff;
  flags(byte, face_count() == kOwnFaceCount
                  ? static_cast<std::uint8_t>(Faces::all(kOwnFaceCount).mask())
                  : kAll);
}

void Codec::direction(base::Direction& direction) {
  kind(direction, base::Direction::kPlusX, static_cast<base::Direction>(face_count() - 1));
}

void Codec::direction(base::Direction& direction, std::uint8_t& remarks, std::uint8_t all) {
  constexpr unsigned kBits = 4;
  constexpr unsigned kDirectionBits = (1U << kBits) - 1;
  auto byte = static_cast<std::uint8_t>(static_cast<unsigned>(base::index(direction)) |
                                        static_cast<unsigned>(remarks) << kBits);
  u8(byte);
  remarks = static_cast<std::uint8_t>(byte >> kBits);
  direction = static_cast<base::Direction>(byte & kDirectionBits);
  require(base::index(direction) < face_count() && (remarks & ~unsigned{all}) == 0);
}

void Codec::moment(std::int64_t& value) {
  auto low = static_cast<std::uint32_t>(value & 0xffffffff);
  auto high = static_cast<std::int32_t>(value >> 32);
  u32(low);
  i32(high);
  value = (std::int64_t{high} << 32U) | low;
  require(value >= -kMomentMost && value <= kMomentMost);
}

void Codec::moment(std::int32_t& value) {
  std::int64_t wide = value;
  moment(wide);
  value = static_cast<std::int32_t>(wide);
  require(value == wide);
}

void Codec::cell(base::Cell& cell) {
  half_cells(cell);
  require(is_near(cell));
}

void Codec::place(base::Cell& cell) {
  half_cells(cell);
  require(cell == kEveryCell || is_near(cell));
}

void Codec::u32(std::uint32_t& value) {
  if (out_ != nullptr) {
    return out_->u32(value);
  }
  value = in_.u32();
}

void Codec::i32(std::int32_t& value) {
  auto bits = static_cast<std::uint32_t>(value);
  u32(bits);
  value = static_cast<std::int32_t>(bits);
}

void Codec::real(float& value) {
  if (out_ != nullptr) {
    return out_->real(static_cast<double>(value));
  }
  value = in_.real();
}

void Codec::long_real(double& value) {
  if (out_ != nullptr) {
    return out_->long_real(value);
  }
  value = in_.long_real();
}

void Codec::half_cells(base::Cell& corner) {
  if (out_ != nullptr) {
    return out_->cell(corner);
  }
  corner = in_.cell();
}

}  // namespace holdfast::agent::wire
