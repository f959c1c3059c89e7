// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/ground_springs.hpp"

#include <algorithm>
#include <optional>

#include "factorization/block_kernels.hpp"
#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

using base::at;

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

FinestGroundSprings::FinestGroundSprings(const ReducedNetwork& network,
                                         const model::Material& material, const GroundTable& ground)
    : network_(network), ground_(ground) {
  for (const GroundBeam& beam : network.ground_beams) {
    if (find(beam) == nullptr) {
      beams_.push_back(
          {.direction = beam.direction,
           .length = beam.length,
           .spring = beam_spring(network.lattice, material, beam.direction, beam.length)});
    }
  }
}

const Spring* FinestGroundSprings::find(const GroundBeam& beam) const {
  const auto found = std::ranges::find_if(beams_, [&](const BeamSpring& known) {
    return known.direction == beam.direction && known.length == beam.length;
  });
  return found == beams_.end() ? nullptr : &found->spring;
}

GroundSpring FinestGroundSprings::operator[](std::size_t i) const {
  const GroundBeam& beam = network_.ground_beams[i];
  const Spring& spring = *find(beam);
  return {
      .node = beam.node,
      .direction = beam.direction,
      .way = spring.direction,
      .length = spring.length,
      .reach = spring.length,
      .middle = spring.middle,
      .stuck = spring.stiffness,
      .stiffness = beam.contact == 0 ? spring.stiffness : ground_[beam.direction][beam.contact]};
}

template <class Springs, class Real>
std::vector<GroundSpring> coarse_ground_springs(const Springs& fine, const Seats<Real>& seat) {
  std::vector<std::int32_t> cluster;
  std::vector<std::size_t> order(fine.size());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    cluster.push_back(seat[at(fine[i].node)].cluster);
    order[i] = i;
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return cluster[i]; });
  std::vector<GroundSpring> coarse;
  for (auto i = order.begin(); i != order.end();) {
    const auto member = [&] { return moved(fine[*i], seat[at(fine[*i].node)]); };
    GroundSpring sum = member();
    double count = 1;
    for (++i; i != order.end() && cluster[*i] == sum.node && fine[*i].direction == sum.direction;
         ++i) {
      add_to(sum, member());
      ++count;
    }
    unite(sum, count);
    coarse.push_back(sum);
  }
  return coarse;
}

template std::vector<GroundSpring> coarse_ground_springs(const FinestGroundSprings&,
                                                         const Seats<float>&);
template std::vector<GroundSpring> coarse_ground_springs(const FinestGroundSprings&,
                                                         const Seats<double>&);
template std::vector<GroundSpring> coarse_ground_springs(const std::vector<GroundSpring>&,
                                                         const Seats<float>&);
template std::vector<GroundSpring> coarse_ground_springs(const std::vector<GroundSpring>&,
                                                         const Seats<double>&);

}  // namespace holdfast::solver
