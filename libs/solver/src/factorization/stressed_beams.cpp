// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "factorization/stressed_beams.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "holdfast/model/lattice_beam.hpp"

namespace holdfast::solver {
namespace {

using base::Mat6;
using base::Vec6;
using mechanics::EndTangent;

void add_times(Mat6<double>& sum, double factor, const Mat6<double>& term) {
  for (std::size_t i = 0; i < 36; ++i) {
    sum.values[i] += factor * term.values[i];
  }
}

/// The stresses of a facet when its module moves by u: what its law holds of the trial force.
Vec6<double> stress_of_facet(const LinearSystem& system, const FacetState& facet,
                             const Vec6<double>& u) {
  const auto corrector =
      mechanics::corrector(system.ground(facet.direction), facet.state, facet.is_held);
  return base::multiply(corrector, system.law().trial_force(facet, u));
}

/// The part of second order of what a facet in any state takes: the even part of its forces at a
/// displacement that is small. A stuck facet has it in closed form.
Vec6<double> even_part(const LinearSystem& system, const mechanics::LargeBeam& beam,
                       const FacetState& facet, const Vec6<double>& u) {
  constexpr double kTurn = 1e-4;  // Errors of fourth order, and of rounding, are some 1e-8.
  const double turn =
      std::max({std::abs(u[3]), std::abs(u[4]), std::abs(u[5]),
                std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) / beam.length()});
  if (turn == 0) {
    return {};
  }
  const double h = kTurn / turn;
  const auto corrector =
      mechanics::corrector(system.ground(facet.direction), facet.state, facet.is_held);
  Vec6<double> sum{};
  for (const double sign : {1.0, -1.0}) {
    Vec6<double> step{};
    base::add_times(step, sign * h, u);
    const auto deformed = beam.deformation(mechanics::moved({}, step), {});
    base::add_to(sum,
                 beam.end_forces(deformed, base::multiply(corrector, beam.stress(deformed))).p);
  }
  for (double& component : sum) {
    component /= 2 * h * h;
  }
  return sum;
}

}  // namespace

StressedBeams::StressedBeams(const LinearSystem& system, const Vecs& displacement, int thread_count)
    : system_(system),
      displacement_(displacement),
      team_(thread_count, displacement.size()),
      beams_(system.beam(), system.robot().lattice()) {}

const StressedBeams::Bases& StressedBeams::bases(base::Direction direction) {
  auto& known = bases_[static_cast<std::size_t>(base::index(direction))];
  if (!known) {
    auto bases = std::make_unique<Bases>();
    for (int k = 0; k < 6; ++k) {
      (*bases)[base::at(k)] = beams_[direction].geometric_stiffness(base::unit<double>(k));
    }
    known = std::move(bases);
  }
  return *known;
}

Vec6<double> StressedBeams::stress(const model::Connection& connection) const {
  return system_.beam().middle_force(connection.direction, displacement_[base::at(connection.a)],
                                     displacement_[base::at(connection.b)]);
}

Vec6<double> StressedBeams::facet_stress(std::size_t facet) const {
  const FacetState& state = system_.facets()[facet];
  return stress_of_facet(system_, state, displacement_[state.module]);
}

EndTangent StressedBeams::blocks(const model::Connection& connection) {
  const Vec s = stress(connection);
  const Bases& bases = this->bases(connection.direction);
  EndTangent sum;
  for (std::size_t k = 0; k < 6; ++k) {
    add_times(sum.pp, s[k], bases[k].pp);
    add_times(sum.pq, s[k], bases[k].pq);
    add_times(sum.qp, s[k], bases[k].qp);
    add_times(sum.qq, s[k], bases[k].qq);
  }
  return sum;
}

Mat6<double> StressedBeams::block(std::size_t facet) {
  const Vec s = facet_stress(facet);
  const Bases& bases = this->bases(system_.facets()[facet].direction);
  Mat6<double> sum;
  for (std::size_t k = 0; k < 6; ++k) {
    add_times(sum, s[k], bases[k].pp);
  }
  return sum;
}

/// The sum over the neighbours of each module of on_pair(module, direction, neighbour). Each
/// connection is looked at from both ends, so that threads share the modules.
template <class OnPair>
StressedBeams::Vecs StressedBeams::sum_over_neighbours(const OnPair& on_pair) {
  Vecs sums(displacement_.size(), Vec{});
  team_.share(0, sums.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (robot().modules()[i].support == model::Support::kFixed) {
        continue;
      }
      const auto neighbours = robot().connected()[i];
      for (std::size_t d = 0; d < neighbours.size(); ++d) {
        if (neighbours[d] >= 0) {
          base::add_to(sums[i],
                       on_pair(i, static_cast<base::Direction>(d), base::at(neighbours[d])));
        }
      }
    }
  });
  return sums;
}

/// The sum of on_pair(direction, module, neighbour), the forces of a beam on its two ends. Robots
/// that no threads share have each connection looked at once.
template <class OnPair>
StressedBeams::Vecs StressedBeams::sum_over_beams(const OnPair& on_pair) {
  if (displacement_.size() >= host::Team::kSharedItemMin) {
    return sum_over_neighbours([&](std::size_t p, base::Direction direction, std::size_t q) {
      return on_pair(direction, p, q).p;
    });
  }
  Vecs sums(displacement_.size(), Vec{});
  for (const model::Connection connection : robot().connections()) {
    const std::size_t p = base::at(connection.a);
    const std::size_t q = base::at(connection.b);
    const mechanics::EndForces forces = on_pair(connection.direction, p, q);
    base::add_to(sums[p], forces.p);
    base::add_to(sums[q], forces.q);
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (robot().modules()[i].support == model::Support::kFixed) {
      sums[i] = Vec{};
    }
  }
  return sums;
}

StressedBeams::Vecs StressedBeams::softening(const Vecs& x) {
  Vecs sums = sum_over_beams([&](base::Direction direction, std::size_t p, std::size_t q) {
    Vec s = system_.beam().middle_force(direction, displacement_[p], displacement_[q]);
    for (double& part : s) {
      part = -part;
    }
    return beams_[direction].geometric_forces(s, x[p], x[q]);
  });
  for (std::size_t i = 0; i < system_.facets().size(); ++i) {
    const FacetState& facet = system_.facets()[i];
    base::add_times(
        sums[facet.module], -1,
        beams_[facet.direction].geometric_forces(facet_stress(i), x[facet.module], Vec{}).p);
  }
  return sums;
}

StressedBeams::Vecs StressedBeams::second_order_forces() {
  Vecs sums = sum_over_beams([&](base::Direction direction, std::size_t p, std::size_t q) {
    return beams_[direction].second_order_forces(displacement_[p], displacement_[q]);
  });
  for (const FacetState& facet : system_.facets()) {
    const Vec& u = displacement_[facet.module];
    const bool is_stuck = facet.state == mechanics::kStuck && facet.is_held;
    base::add_to(sums[facet.module], is_stuck
                                         ? beams_[facet.direction].second_order_forces(u, Vec{}).p
                                         : even_part(system_, beams_[facet.direction], facet, u));
  }
  return sums;
}

StressedBeams::Vecs StressedBeams::stiffness_times(const Vecs& x) {
  Vecs sums = sum_over_neighbours([&](std::size_t p, base::Direction direction, std::size_t q) {
    return system_.beam().end_force(direction, x[p], x[q]);
  });
  for (const FacetState& facet : system_.facets()) {
    base::add_to(sums[facet.module], system_.law().force(facet, x[facet.module]));
  }
  return sums;
}

}  // namespace holdfast::solver
