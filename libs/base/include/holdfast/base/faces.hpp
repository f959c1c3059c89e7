// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>

#include "holdfast/base/cell.hpp"

/// Sets of directions, one bit each, for modules that count every byte.
namespace holdfast::base {

/// A set of directions: bit i of `mask()` stands for the direction with index i, so that a
/// direction and its opposite are neighbouring bits. `Bits` is the unsigned type that holds them.
/// A walk through a set meets its directions by ascending index; it walks through the set as it was
/// at its beginning, so the body of a loop may change the set.
template <class Bits>
class BasicFaces {
 public:
  static constexpr int kDirectionCountMax = 8 * static_cast<int>(sizeof(Bits));

  constexpr BasicFaces() = default;

  constexpr BasicFaces(std::initializer_list<Direction> directions) {
    for (const Direction direction : directions) {
      add(direction);
    }
  }

  /// Makes the set of one direction.
  static constexpr BasicFaces only(Direction direction) { return from_mask(bit(direction)); }

  /// Makes the set of the lowest `direction_count` directions, those that a lattice has.
  static constexpr BasicFaces all(int direction_count = kDirectionCount) {
    return from_mask(direction_count == kDirectionCountMax
                         ? static_cast<Bits>(~Bits{0})
                         : static_cast<Bits>((std::uint32_t{1} << direction_count) - 1));
  }

  /// Takes the set from its bits, as from a message. Which of them may be set is up to the caller.
  static constexpr BasicFaces from_mask(Bits mask) {
    BasicFaces faces;
    faces.mask_ = mask;
    return faces;
  }

  constexpr Bits mask() const { return mask_; }

  constexpr bool has(Direction direction) const { return (mask_ & bit(direction)) != 0; }

  constexpr bool is_empty() const { return mask_ == 0; }

  constexpr int count() const { return std::popcount(mask_); }

  constexpr void add(Direction direction) { mask_ = static_cast<Bits>(mask_ | bit(direction)); }

  constexpr void remove(Direction direction) { mask_ = static_cast<Bits>(mask_ & ~bit(direction)); }

  /// Makes `direction` an element, or no element, of the set.
  constexpr void set(Direction direction, bool is_element) {
    is_element ? add(direction) : remove(direction);
  }

  /// The lowest direction of a set that is not empty.
  constexpr Direction first() const { return static_cast<Direction>(std::countr_zero(mask_)); }

  /// The set with every direction replaced by its opposite: neighbouring bits change places.
  constexpr BasicFaces opposite() const {
    constexpr auto kEven = static_cast<Bits>(static_cast<Bits>(~Bits{0}) / 3);  // 0101...
    return from_mask(static_cast<Bits>(static_cast<Bits>((mask_ & kEven) << 1) |
                                       static_cast<Bits>((mask_ >> 1) & kEven)));
  }

  friend constexpr BasicFaces operator|(BasicFaces a, BasicFaces b) {
    return from_mask(static_cast<Bits>(a.mask_ | b.mask_));
  }

  friend constexpr BasicFaces operator&(BasicFaces a, BasicFaces b) {
    return from_mask(static_cast<Bits>(a.mask_ & b.mask_));
  }

  /// The elements of `a` that are not elements of `b`.
  friend constexpr BasicFaces operator-(BasicFaces a, BasicFaces b) {
    return from_mask(static_cast<Bits>(a.mask_ & ~b.mask_));
  }

  constexpr BasicFaces& operator|=(BasicFaces other) { return *this = *this | other; }

  constexpr BasicFaces& operator&=(BasicFaces other) { return *this = *this & other; }

  constexpr BasicFaces& operator-=(BasicFaces other) { return *this = *this - other; }

  friend constexpr bool operator==(BasicFaces, BasicFaces) = default;

  /// Walks through a set by ascending index: the rest of it, whose lowest direction is the current.
  class Iterator {
   public:
    constexpr explicit Iterator(BasicFaces rest) : rest_(rest) {}

    constexpr Direction operator*() const { return rest_.first(); }

    constexpr Iterator& operator++() {
      rest_.mask_ = static_cast<Bits>(rest_.mask_ & (rest_.mask_ - 1U));
      return *this;
    }

    friend constexpr bool operator==(Iterator, Iterator) = default;

   private:
    BasicFaces rest_;
  };

  constexpr Iterator begin() const { return Iterator(*this); }

  constexpr Iterator end() const { return Iterator(BasicFaces{}); }

 private:
  static constexpr Bits bit(Direction direction) {
    return static_cast<Bits>(1U << static_cast<unsigned>(index(direction)));
  }

  Bits mask_ = 0;
};

/// A set of directions of a lattice with up to eight of them, in one byte: faces of cubes, of
/// hexagonal prisms, and all that a module's program stores.
using Faces = BasicFaces<std::uint8_t>;

/// A set of directions of any lattice (face-centred has twelve), as wide as in messages.
using WideFaces = BasicFaces<std::uint16_t>;

static_assert(sizeof(Faces) == 1 && sizeof(WideFaces) == 2);

}  // namespace holdfast::base
