// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "ground_springs.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "../block_kernels.hpp"
#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

using base::at;

/// Ground springs of beams; what was asked last is remembered, as most are alike.
class BeamGroundSprings {
 public:
  BeamGroundSprings(const base::Lattice& lattice, const model::Material& material)
      : lattice_(lattice), material_(material) {}

  GroundSpring spring(const GroundBeam& beam) {
    if (beam.direction != last_.direction || beam.length != last_.length) {
      spring_ = beam_spring(lattice_, material_, beam.direction, beam.length);
      last_ = beam;
    }
    return {.node = beam.node,
            .direction = beam.direction,
            .way = spring_.direction,
            .length = spring_.length,
            .reach = spring_.length,
            .middle = spring_.middle,
            .stuck = spring_.stiffness,
            .stiffness = spring_.stiffness};
  }

 private:
  const base::Lattice& lattice_;
  const model::Material& material_;
  GroundBeam last_;  ///< None yet: of no length.
  Spring spring_;
};

/// A ground spring of a member as its cluster has it.
template <class Real>
GroundSpring moved(const GroundSpring& spring, const Seat<Real>& seat) {
  const Point arm = offset(seat);
  return {
      .node = seat.cluster,
      .direction = spring.direction,
      .way = spring.way,
      .length = spring.length,
      .reach = spring.reach + behind(arm, spring.way),
      .middle = {spring.middle[0] + arm[0], spring.middle[1] + arm[1], spring.middle[2] + arm[2]},
      .stuck = carried(spring.stuck, arm),
      .stiffness = carried(spring.stiffness, arm)};
}

void add_to(GroundSpring& sum, const GroundSpring& spring) {
  base::add_to(sum.stuck, spring.stuck);
  base::add_to(sum.stiffness, spring.stiffness);
  sum.length += spring.length;
  sum.reach += spring.reach;
  for (std::size_t k = 0; k < 3; ++k) {
    sum.middle[k] += spring.middle[k];
  }
}

/// The inverse of A^-1 + B^-1 - C^-1; none if one of them is singular.
std::optional<Mat> in_series(const Mat& a, const Mat& b, const Mat& c) {
  Mat sum;
  Mat inverse;
  if (!invert(a, sum) || !invert(b, inverse)) {
    return std::nullopt;
  }
  base::add_to(sum, inverse);
  if (!invert(c, inverse)) {
    return std::nullopt;
  }
  base::add_to(sum, scaled(inverse, -1));
  return invert(sum, inverse) ? std::optional(inverse) : std::nullopt;
}

/// Makes a sum of ground springs of one cluster in one direction a single one. What does not resist
/// some motion at all, like an open facet without weak springs, cannot be lengthened and stays.
void unite(GroundSpring& sum, double count) {
  for (double& x : sum.middle) {
    x /= count;
  }
  sum.reach /= count;
  const Mat longer = stretched(sum.stuck, sum.middle, sum.way, sum.length / count, sum.reach);
  const bool is_stuck = sum.stiffness.values == sum.stuck.values;
  sum.stiffness =
      is_stuck ? longer : in_series(longer, sum.stiffness, sum.stuck).value_or(sum.stiffness);
  sum.stuck = longer;
  sum.length = sum.reach;
}

}  // namespace

std::vector<GroundSpring> finest_ground_springs(const ReducedNetwork& network,
                                                const model::Material& material,
                                                const GroundTable& ground) {
  std::vector<GroundSpring> springs;
  springs.reserve(network.ground_beams.size());
  BeamGroundSprings beams(network.lattice, material);
  for (const GroundBeam& beam : network.ground_beams) {
    springs.push_back(beams.spring(beam));
    if (beam.contact != 0) {
      springs.back().stiffness = ground[beam.direction][beam.contact];
    }
  }
  return springs;
}

template <class Real>
std::vector<GroundSpring> coarse_ground_springs(const std::vector<GroundSpring>& fine,
                                                const Seats<Real>& seat) {
  const auto cluster = [&](std::size_t i) { return seat[at(fine[i].node)].cluster; };
  std::vector<std::size_t> order(fine.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, cluster);
  std::vector<GroundSpring> coarse;
  for (auto i = order.begin(); i != order.end();) {
    const std::size_t first = *i;
    coarse.push_back(moved(fine[first], seat[at(fine[first].node)]));
    double count = 1;
    for (++i; i != order.end() && cluster(*i) == cluster(first) &&
              fine[*i].direction == fine[first].direction;
         ++i) {
      add_to(coarse.back(), moved(fine[*i], seat[at(fine[*i].node)]));
      ++count;
    }
    unite(coarse.back(), count);
  }
  return coarse;
}

template std::vector<GroundSpring> coarse_ground_springs(const std::vector<GroundSpring>&,
                                                         const Seats<float>&);
template std::vector<GroundSpring> coarse_ground_springs(const std::vector<GroundSpring>&,
                                                         const Seats<double>&);

}  // namespace holdfast::solver
