// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/free_faces/load_way.hpp"

#include "algebra/scalar.hpp"

namespace holdfast::agent {
namespace {

/// Room for rounding in single precision on the wire: of the energy, which is small where its terms
/// are not.
constexpr double kEnergySafety = 1.01;

double larger_of(double a, double b) { return b > a || b != b ? b : a; }

/// kappa: by how much forces of the energy 1 can change 2 |m| / a + f at most, in N.
double tension_of_energy(const Setup& setup) {
  const double bending = larger_of(setup.beam.bend_x, setup.beam.bend_y) / 4;
  return square_root(setup.beam.axial + 4 * bending / (setup.facet_mm * setup.facet_mm));
}

/// What a beam's force in its middle is divided by, for its energy.
base::Vec6<double> middle_stiffness(const Setup& setup) {
  return {setup.beam.shear_x,    setup.beam.shear_y,    setup.beam.axial,
          setup.beam.bend_y / 4, setup.beam.bend_x / 4, setup.beam.twist};
}

double tension_of(const Setup& setup, const MiddleLoad& load) {
  const double bending = larger_of(absolute(load.bending_x_nmm), absolute(load.bending_y_nmm));
  return 2 * bending / setup.facet_mm + load.axial_n;
}

}  // namespace

LoadWay LoadWay::certain() { return {}; }

LoadWay LoadWay::from_foot(const Setup& setup, const base::Cell& cell, const MiddleLoad& now) {
  LoadWay way;
  way.is_certain_ = false;
  way.has_foot_ = true;
  way.foot_ = {cell.x, cell.y};
  way.foot_load_ = now;
  way.add_energy(setup, cell, base::Direction::kMinusZ);
  return way;
}

void LoadWay::pass(const Setup& setup, const base::Cell& cell, base::Direction direction,
                   const MiddleLoad& now, bool is_alone) {
  if (is_alone) {
    alone_.pass(setup, cell, direction, now);
    return;
  }
  is_certain_ = false;
  shared_.pass(setup, cell, direction, now);
  add_energy(setup, cell, direction);
}

/// A load at (x, y) makes forces l = l_0 + l_x x + l_y y.
void LoadWay::add_energy(const Setup& setup, const base::Cell& cell, base::Direction direction) {
  const auto force_at = [&](const PlanePoint& place) {
    return added_force(setup, cell, direction, place);
  };
  const base::Vec6<double> at_root = force_at({0, 0});
  const base::Vec6<double> east = force_at({1, 0});
  const base::Vec6<double> north = force_at({0, 1});
  const base::Vec6<double> stiffness = middle_stiffness(setup);
  for (std::size_t i = 0; i < 6; ++i) {
    const double l_0 = at_root[i];
    const double l_x = east[i] - l_0;
    const double l_y = north[i] - l_0;
    const std::array<double, 6> terms = {l_0 * l_0, 2 * l_0 * l_x, 2 * l_0 * l_y,
                                         l_x * l_x, 2 * l_x * l_y, l_y * l_y};
    for (std::size_t term = 0; term < terms.size(); ++term) {
      energy_[term] += terms[term] / stiffness[i];
    }
  }
}

double LoadWay::energy_with(const Setup& setup, const base::Cell& cell) const {
  const PlanePoint place = centre_of(setup, cell);
  const std::array<double, 6> products = {
      1, place.x, place.y, place.x * place.x, place.x * place.y, place.y * place.y};
  double energy = 0;
  double size = 0;
  for (std::size_t term = 0; term < products.size(); ++term) {
    energy += energy_[term] * products[term];
    size += absolute(energy_[term] * products[term]);
  }
  return kEnergySafety * energy + 1e-5 * size;
}

double LoadWay::bound_with(const Setup& setup, const base::Cell& cell, double ratio) const {
  const double strength = setup.strength_vertical_n < setup.strength_lateral_n
                              ? setup.strength_vertical_n
                              : setup.strength_lateral_n;
  const double all_this_way = larger_of(ratio, shared_.ratio_with(setup, cell));
  const double reach = tension_of_energy(setup) * square_root(energy_with(setup, cell));
  return (ratio + all_this_way + reach / strength) / 2;
}

double LoadWay::tension_with(const Setup& setup, const base::Cell& cell, double margin_n) const {
  double all_this_way = -margin_n;
  if (has_foot_) {
    const base::Vec6<double> added = added_force(setup, {foot_[0], foot_[1], 0},
                                                 base::Direction::kMinusZ, centre_of(setup, cell));
    const MiddleLoad load = {.axial_n = foot_load_.axial_n + added[2],
                             .bending_x_nmm = foot_load_.bending_x_nmm + added[3],
                             .bending_y_nmm = foot_load_.bending_y_nmm + added[4]};
    all_this_way = larger_of(all_this_way, tension_of(setup, load));
  }
  const double reach = tension_of_energy(setup) * square_root(energy_with(setup, cell));
  return (-margin_n + all_this_way + reach) / 2;
}

// ---- Messages.

base::Vec6<float> LoadWay::part(int index, float elsewhere) const {
  const CarriedLoad::Terms& alone = alone_.terms();
  const CarriedLoad::Terms& shared = shared_.terms();
  const auto energy = [&](std::size_t term) { return static_cast<float>(energy_[term]); };
  switch (index) {
    case 0:
      return {alone[0], alone[1], alone[2], alone[3], alone[4], alone[5]};
    case 1:
      return {alone[6], alone[7], alone[8], elsewhere, is_certain_ ? 1.0F : 0.0F, 0};
    case 2:
      return {shared[0], shared[1], shared[2], shared[3], shared[4], shared[5]};
    case 3:
      return {shared[6], shared[7], shared[8], energy(0), energy(1), energy(2)};
    case 4:
      return {energy(3), energy(4), energy(5), has_foot_ ? 1.0F : 0.0F, 0, 0};
    default:
      return {static_cast<float>(foot_[0]),
              static_cast<float>(foot_[1]),
              static_cast<float>(foot_load_.axial_n),
              static_cast<float>(foot_load_.bending_x_nmm),
              static_cast<float>(foot_load_.bending_y_nmm),
              0};
  }
}

float LoadWay::take_part(int index, const base::Vec6<float>& part) {
  const auto real = [&](std::size_t i) { return static_cast<double>(part[i]); };
  const auto take_energy = [&](std::size_t first, std::size_t from) {
    for (std::size_t i = 0; i < 3; ++i) {
      energy_[first + i] = real(from + i);
    }
  };
  switch (index) {
    case 0:
      alone_.take_first(part);
      break;
    case 1:
      alone_.take_last(part);
      is_certain_ = part[4] == 1;
      return part[3];
    case 2:
      shared_.take_first(part);
      break;
    case 3:
      shared_.take_last(part);
      take_energy(0, 3);
      break;
    case 4:
      take_energy(3, 0);
      has_foot_ = part[3] == 1;
      break;
    default:
      foot_ = {place_of(part[0]), place_of(part[1])};
      foot_load_ = {.axial_n = real(2), .bending_x_nmm = real(3), .bending_y_nmm = real(4)};
  }
  return kNoLoadRatio;
}

/// Reals of a neighbour may be anything.
std::int32_t LoadWay::place_of(float real) {
  constexpr float kMost = 2.0F * base::kCoordinateMax;
  return real >= -kMost && real <= kMost ? static_cast<std::int32_t>(real) : 0;
}

}  // namespace holdfast::agent
