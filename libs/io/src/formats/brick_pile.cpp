// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Stud joints after StableLego: three points that hold 0.98 N each, four below a brick one stud
// wide, which are an eighth and a quarter of a stud's pitch from its middle. What a joint of a
// document cannot say is that the points are no circle; levers are those for bending about x and y.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "formats/bricks.hpp"
#include "holdfast/host/text.hpp"
#include "holdfast/model/cell_index.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr double kStudPitchMm = 8;
constexpr double kBrickHeightMm = 9.6;
constexpr double kPlasticMpa = 2200;  ///< ABS.

/// How a stud holds the brick above it.
struct StudHold {
  double strength_n;
  double lever_mm;
};

constexpr StudHold kWideHold = {3 * 0.98, kStudPitchMm / 8};
constexpr StudHold kNarrowHold = {4 * 0.98, kStudPitchMm / 4};

/// A stud bends as its points do, whose mean square distance from an axis is at least this.
constexpr double kMeanSquareMm2 = 4.0 / 3;

/// Sides hold nothing; what comes later beside a brick breaks off. A safety factor of
/// kSafetyFactorMax leaves a number that is allowed.
constexpr double kSideStrengthN = 1e-8;

bool is_narrow(const BrickSize& size) { return std::min(size.along_x, size.along_y) == 1; }

/// The masses in g of StableLego's library, by length.
struct LengthMass {
  double length;
  double mass_g;
};

constexpr auto kNarrowMasses =
    std::to_array<LengthMass>({{1, 0.43}, {2, 0.81}, {4, 1.57}, {6, 2.28}, {8, 3.03}});
constexpr auto kWideMasses = std::to_array<LengthMass>({{2, 1.15}, {4, 2.16}, {6, 3.23}});

/// Takes the mass of a length from the line through the two entries around it, or the last two.
template <std::size_t N>
double interpolate(const std::array<LengthMass, N>& list, double length) {
  std::size_t i = 0;
  while (i + 2 < N && list[i + 1].length < length) {
    ++i;
  }
  const LengthMass& a = list[i];
  const LengthMass& b = list[i + 1];
  return a.mass_g + (b.mass_g - a.mass_g) * (length - a.length) / (b.length - a.length);
}

/// The mass of a brick of one height in g. Those wider than two studs weigh by their width.
double mass_of(const BrickSize& size) {
  const auto [width, length] = std::minmax(size.along_x, size.along_y);
  return width == 1 ? interpolate(kNarrowMasses, length)
                    : interpolate(kWideMasses, length) * width / 2;
}

}  // namespace

void BrickPile::add(const base::Cell& corner, const BrickSize& size, double mass_g) {
  bricks_.push_back({reading_.document.modules.size(), size, mass_g});
  for (std::int32_t y = 0; y < size.along_y && !reading_.has_failed(); ++y) {
    for (std::int32_t x = 0; x < size.along_x; ++x) {
      reading_.add(corner.x + x, corner.y + y, corner.z);
      brick_of_.push_back(bricks_.size() - 1);
    }
  }
}

void BrickPile::finish(BrickGround ground) {
  refuse_options();
  if (reading_.has_failed() || bricks_.empty()) {
    return;
  }
  take_material();
  take_kinds();
  if (ground == BrickGround::kBasePlate && !reading_.options.support) {
    take_base_plate();
  }
  if (reading_.has_failed()) {
    return;
  }
  take_joints();
  reading_.warn_of_all(fmt::format(
      "{} of ABS, rigid and joined by studs alone: each stud holds {:.2f} N, {:.2f} N below a "
      "brick "
      "one stud wide; strengths and masses are StableLego's, as the file has none",
      host::counted(bricks_.size(), "brick"), kWideHold.strength_n, kNarrowHold.strength_n));
  reading_.warn_of_all(
      plate_count_ > 0
          ? fmt::format("the ground is a base plate with studs, {}; where the support level is "
                        "given it is a floor without studs",
                        host::counted(plate_count_, "fixed module"))
          : std::string("the floor has no studs"));
}

void BrickPile::refuse_options() {
  const ReadOptions& options = reading_.options;
  if (!options.robot.empty() || options.lattice.value_or(base::kCubic) != base::kCubic) {
    reading_.fail({base::ErrorCode::kBadInput,
                   "the file is one of bricks, but another robot or lattice is asked for"});
  }
}

void BrickPile::take_material() {
  Document& document = reading_.document;
  model::Material& material = document.material;
  constexpr double kFromPitch = std::numeric_limits<double>::quiet_NaN();
  material.pitch_mm = kStudPitchMm;
  document.extension.pitch_mm = {kStudPitchMm, kStudPitchMm, kBrickHeightMm};
  material.elastic_modulus_mpa = kPlasticMpa;
  material.facet_mm = kFromPitch;
  material.section_area_mm2 = kFromPitch;
  material.torsion_mm4 = kFromPitch;
  material.moment_x_mm4 = kStudPitchMm * kStudPitchMm * kMeanSquareMm2;
  material.moment_y_mm4 = material.moment_x_mm4;
  material.mass_kg = mass_of({1, 1}) / 1000;
  material.strength_vertical_n = kWideHold.strength_n;
  material.strength_lateral_n = kSideStrengthN;
  document.extension.connectors = {{{"lever_mm", Spread::kAll, {kWideHold.lever_mm}}},
                                   model::BendingLaw::kRound};
}

void BrickPile::take_kinds() {
  Extension& extension = reading_.document.extension;
  for (const Brick& brick : bricks_) {
    const auto [width, length] = std::minmax(brick.size.along_x, brick.size.along_y);
    const std::string name =
        fmt::format("{} {}x{}", brick.mass_g > 0 ? "weight" : "brick", width, length);
    const std::size_t studs = base::at(brick.size.along_x) * base::at(brick.size.along_y);
    if (std::ranges::find(extension.kinds, name, &KindEntry::name) == extension.kinds.end()) {
      const double mass_g = brick.mass_g > 0 ? brick.mass_g : mass_of(brick.size);
      extension.kinds.push_back({name, mass_g / 1000 / static_cast<double>(studs), {}});
    }
    for (std::size_t i = 0; i < studs; ++i) {
      extension.own.push_back({0, brick.first_module + i, name, {}});
    }
  }
}

void BrickPile::take_base_plate() {
  const std::vector<ModuleEntry>& modules = reading_.document.modules;
  const std::size_t count = modules.size();
  const auto z_of = [](const ModuleEntry& module) { return module.cell.z; };
  const std::int32_t lowest = std::ranges::min_element(modules, {}, z_of)->cell.z;
  model::CellIndex plate(count);  // Bricks that share a cell are no fault of the plate.
  for (std::size_t i = 0; i < count && !reading_.has_failed(); ++i) {
    const base::Cell cell = modules[i].cell;
    if (cell.z == lowest &&
        plate.insert(cell, static_cast<std::int32_t>(i)) == model::CellIndex::kNone) {
      reading_.add(cell.x, cell.y, cell.z - 1, std::nullopt, true);
      brick_of_.push_back(brick_of_[i]);
      ++plate_count_;
    }
  }
  reading_.document.extension.has_floor = false;
}

void BrickPile::take_joints() {
  const std::vector<ModuleEntry>& modules = reading_.document.modules;
  Extension& extension = reading_.document.extension;
  model::CellIndex index(modules.size());
  for (std::size_t i = 0; i < modules.size(); ++i) {
    index.insert(modules[i].cell, static_cast<std::int32_t>(i));
  }
  const ConnectionEntry narrow = {
      {},
      {{{std::string(kStrengthKey), Spread::kAll, {kNarrowHold.strength_n}},
        {"lever_mm", Spread::kAll, {kNarrowHold.lever_mm}}},
       {}}};
  for (std::size_t i = 0; i < modules.size(); ++i) {
    const base::Cell& cell = modules[i].cell;
    for (const base::Direction side : {base::Direction::kPlusX, base::Direction::kPlusY}) {
      const base::Cell beside = base::neighbour(cell, side);
      const std::int32_t found = index.find(beside);
      if (found != model::CellIndex::kNone && brick_of_[base::at(found)] != brick_of_[i]) {
        extension.open.push_back({cell, beside});
      }
    }
    const base::Cell below = base::neighbour(cell, base::Direction::kMinusZ);
    if (is_narrow(bricks_[brick_of_[i]].size) && index.find(below) != model::CellIndex::kNone) {
      extension.connections.push_back(narrow);
      extension.connections.back().between = {below, cell};
    }
  }
  for (const Brick& brick : bricks_) {
    const std::size_t studs = base::at(brick.size.along_x) * base::at(brick.size.along_y);
    std::vector<base::Cell> body;
    for (std::size_t i = brick.first_module; studs > 1 && i < brick.first_module + studs; ++i) {
      body.push_back(modules[i].cell);
    }
    if (studs > 1) {
      extension.bodies.push_back(std::move(body));
    }
  }
}

}  // namespace holdfast::io
