// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/foreign_reading.hpp"

namespace holdfast::io {

/// The studs of a brick of one height.
struct BrickSize {
  std::int32_t along_x = 1;
  std::int32_t along_y = 1;
};

/// A brick of StableLego's library that is not turned.
struct LibraryBrick {
  std::int32_t number;
  BrickSize size;
  double mass_g = 0;  ///< Of what is no brick; 0: as bricks of its size have.
};

/// The brick of StableLego's library with that number; nullptr for other numbers.
const LibraryBrick* find_stable_lego_brick(std::int32_t number);

/// What bricks stand on where no option says it.
enum class BrickGround : std::uint8_t {
  kFloor,      ///< It pushes, and does not hold.
  kBasePlate,  ///< It has studs.
};

/// Makes bricks of a file rigid bodies, one module for each stud, that only studs hold together.
class BrickPile {
 public:
  /// The reading must outlive the pile.
  explicit BrickPile(ForeignReading& reading) : reading_(reading) {}

  /// Adds a brick by its corner with the lowest coordinates; `mass_g` as in LibraryBrick.
  void add(const base::Cell& corner, const BrickSize& size, double mass_g = 0);

  /// Says in the document what the bricks are made of and how they are joined; to be called once,
  /// behind the last brick. A failure if an option asks for other modules than bricks.
  void finish(BrickGround ground);

 private:
  struct Brick {
    std::size_t first_module;
    BrickSize size;
    double mass_g;
  };

  void refuse_options();
  void take_material();
  void take_kinds();
  void take_base_plate();
  void take_joints();

  ForeignReading& reading_;
  std::vector<Brick> bricks_;
  std::vector<std::size_t> brick_of_;  ///< By module, those of the base plate included.
  std::size_t plate_count_ = 0;        ///< Modules of the base plate, the last ones.
};

}  // namespace holdfast::io
