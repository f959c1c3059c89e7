// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "ratio_screen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "dense.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::plan {
namespace {

using base::Mat6;
using base::Vec6;
using model::ConnectorLaw;

/// Columns are kept of no more connections than this: where more compete no few decide, and to look
/// at all takes as long as a solution.
constexpr std::size_t kKeptMax = 64;

constexpr std::size_t kGroupSize = 16;

/// Room for rounding in an energy, as a share of it.
constexpr double kEnergyRounding = 1e-6;

/// A connection's middle force by rows that multiply the displacement of its first end.
std::array<Vec6<double>, 6> rows_of(const model::LatticeBeam<double>& beam,
                                    base::Direction direction, bool is_first) {
  std::array<Vec6<double>, 6> rows;
  for (int column = 0; column < 6; ++column) {
    const Vec6<double> unit = base::unit<double>(column);
    const Vec6<double> force =
        is_first ? beam.middle_force(direction, unit, {}) : beam.middle_force(direction, {}, unit);
    for (std::size_t i = 0; i < 6; ++i) {
      rows[i][static_cast<std::size_t>(column)] = force[i];
    }
  }
  return rows;
}

/// G = M K11^-1 M' for a middle force M u of one end's displacement: of all displacements of the
/// beam with the energy 1, a component i of the force is at most the root of G_ii.
Mat6<double> force_bounds(const model::LatticeBeam<double>& beam, base::Direction direction) {
  const Mat6<double> stiffness = beam.block_11(direction);
  DenseSystem system(6);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      system.at(i, k) = stiffness.at(static_cast<int>(i), static_cast<int>(k));
    }
  }
  HOLDFAST_CHECK(system.factor());
  const auto rows = rows_of(beam, direction, true);
  Mat6<double> bounds;
  for (int k = 0; k < 6; ++k) {
    Vec6<double> u = rows[static_cast<std::size_t>(k)];
    system.solve(u);
    for (int i = 0; i < 6; ++i) {
      bounds.at(i, k) = base::dot(rows[static_cast<std::size_t>(i)], u);
    }
  }
  return bounds;
}

/// The largest load ratio of all forces of a beam with the energy 1, or more.
double rise_of(const ConnectorLaw& law, const Mat6<double>& bounds) {
  const auto size = [&](int i) { return std::sqrt(bounds.at(i, i)); };
  const double across = std::hypot(size(0), size(1));
  double opens = 0;
  if (law.bending == model::BendingLaw::kSquare) {
    for (const int i : {3, 4}) {
      const double both = 2 * std::abs(bounds.at(2, i)) / law.lever_mm;
      opens = std::max(opens, std::sqrt(bounds.at(2, 2) + both +
                                        bounds.at(i, i) / (law.lever_mm * law.lever_mm)));
    }
  } else {
    opens = size(2) + std::hypot(size(3), size(4)) / law.lever_mm;
  }
  const double slips =
      law.friction ? size(2) + (across + size(5) / law.torsion_radius_mm) / *law.friction : 0;
  return std::max({opens / law.strength_n, slips / law.strength_n, across / law.shear_strength_n,
                   size(5) / law.torsion_strength_nmm});
}

}  // namespace

RatioScreen::RatioScreen(const model::Robot& robot, const solver::Influence& influence,
                         const std::vector<Vec>& displacement)
    : robot_(robot), influence_(influence) {
  const model::LatticeBeam<double>& beam = influence.beam();
  std::vector<Mat6<double>> bounds;
  for (const base::Direction direction : base::directions(robot.lattice())) {
    bounds.push_back(force_bounds(beam, direction));
  }
  beside_.resize(robot.modules().size());
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const model::Connection& pair = robot.connections()[i];
    const ConnectorLaw& law = robot.connector(pair);
    beside_[base::at(pair.a)].push_back(i);
    beside_[base::at(pair.b)].push_back(i);
    forces_.push_back(beam.middle_force(pair.direction, displacement[base::at(pair.a)],
                                        displacement[base::at(pair.b)]));
    members_.push_back(
        {.connection = i,
         .ratio = model::load_ratio(law, forces_.back()).ratio,
         .rise = rise_of(law, bounds[static_cast<std::size_t>(base::index(pair.direction))])});
    rise_max_ = std::max(rise_max_, members_.back().rise);
  }
  std::ranges::stable_sort(members_, std::greater<>(), &Member::ratio);
  ratio_max_ = members_.empty() ? -std::numeric_limits<double>::infinity() : members_.front().ratio;
  make_groups();
}

void RatioScreen::make_groups() {
  groups_.clear();
  for (std::size_t i = kept_count_; i < members_.size(); ++i) {
    if ((i - kept_count_) % kGroupSize == 0) {
      groups_.push_back({.ratio = members_[i].ratio});
    }
    groups_.back().rise = std::max(groups_.back().rise, members_[i].rise);
    groups_.back().weighted_rise =
        std::max(groups_.back().weighted_rise, members_[i].weighted_rise);
  }
}

void RatioScreen::keep_columns(double target, std::span<const double> energies,
                               std::size_t change_count) {
  // By energy, how many of the members have to be known so that bounds suffice for the others.
  std::vector<std::size_t> needed;
  for (const double energy : energies) {
    const auto last = std::find_if(members_.rbegin(), members_.rend(), [&](const Member& member) {
      return member.ratio + member.rise * std::sqrt(energy) > std::max(target, ratio_max_);
    });
    needed.push_back(static_cast<std::size_t>(members_.rend() - last));
  }
  std::ranges::sort(needed);
  double least = static_cast<double>(change_count);
  for (std::size_t i = 0; i < needed.size() && needed[i] <= kKeptMax; ++i) {
    const double left = static_cast<double>(needed.size() - i - 1) *
                        static_cast<double>(change_count) / static_cast<double>(needed.size());
    const double cost = 6 * static_cast<double>(needed[i]) + left;
    kept_count_ = cost < least ? needed[i] : kept_count_;
    least = std::min(least, cost);
  }
  std::vector<std::vector<PointLoad>> quantities;
  for (std::size_t i = 0; i < kept_count_; ++i) {
    const model::Connection& pair = robot_.connections()[members_[i].connection];
    const auto rows_a = rows_of(influence_.beam(), pair.direction, true);
    const auto rows_b = rows_of(influence_.beam(), pair.direction, false);
    for (std::size_t k = 0; k < 6; ++k) {
      quantities.push_back({{.module = base::at(pair.a), .load = rows_a[k]},
                            {.module = base::at(pair.b), .load = rows_b[k]}});
    }
  }
  kept_responses_ = Responses(influence_, quantities);
  make_groups();
}

std::vector<double> RatioScreen::weights(double target) const {
  std::vector<double> weights(members_.size(), 1);
  for (const Member& member : members_) {
    const double stiffness = member.rise / rise_max_;
    const double pressed = target / std::max(target, target - member.ratio);
    weights[member.connection] = std::max(1e-12, stiffness * stiffness * pressed * pressed);
  }
  return weights;
}

void RatioScreen::set_weights(std::vector<double> weights) {
  weights_ = std::move(weights);
  for (Member& member : members_) {
    member.weighted_rise = member.rise / std::sqrt(weights_[member.connection]);
  }
  make_groups();
}

std::optional<double> RatioScreen::largest(const LoadChange& change, double known) const {
  double largest = known;
  for (std::size_t i = 0; i < kept_count_; ++i) {
    largest = std::max(largest, kept_ratio(i, change.loads));
  }
  const double rounding = kEnergyRounding * std::abs(change.energy);
  Bounds bounds{.root = std::sqrt(change.energy + rounding),
                .weighted_root = std::sqrt(std::max(change.weighted_energy, 0.0) + rounding),
                .known = largest};
  if (is_below(bounds)) {
    return largest;
  }
  if (change.loads.size() != 1) {
    return std::nullopt;
  }
  bounds = beside_host(change.loads.front(), change, largest);
  return is_below(bounds) ? std::optional(bounds.known) : std::nullopt;
}

bool RatioScreen::is_below(const Bounds& bounds) const {
  const auto is_bound_below = [&](const auto& one) {
    return one.ratio + std::min(one.rise * bounds.root, one.weighted_rise * bounds.weighted_root) <=
           bounds.known;
  };
  const auto is_member_below = [&](const Member& member) {
    return is_bound_below(member) ||
           std::ranges::find(bounds.exact, member.connection) != bounds.exact.end();
  };
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].ratio + rise_max_ * bounds.root <= bounds.known) {
      break;  // And so are all that follow.
    }
    const std::size_t first = kept_count_ + g * kGroupSize;
    const std::size_t count = std::min(kGroupSize, members_.size() - first);
    if (!is_bound_below(groups_[g]) &&
        !std::ranges::all_of(std::span(members_).subspan(first, count), is_member_below)) {
      return false;
    }
  }
  return true;
}

/// The connections of the module that bears a load, exactly: from K^-1 between it and those beside
/// it. Their energy is not left for any other.
RatioScreen::Bounds RatioScreen::beside_host(const PointLoad& load, LoadChange change,
                                             double known) const {
  Bounds bounds{.known = known};
  const double rounding = kEnergyRounding * std::abs(change.energy);
  const model::LatticeBeam<double>& beam = influence_.beam();
  for (const std::size_t connection : beside_[load.module]) {
    const model::Connection& pair = robot_.connections()[connection];
    const auto moved = [&](std::int32_t module) {
      return base::multiply(influence_.inverse().between(base::at(module), load.module), load.load);
    };
    const Vec a = moved(pair.a);
    const Vec b = moved(pair.b);
    Vec force = beam.middle_force(pair.direction, a, b);
    base::add_to(force, forces_[connection]);
    bounds.known = std::max(bounds.known, model::load_ratio(robot_.connector(pair), force).ratio);
    const double energy = base::dot(a, beam.end_force(pair.direction, a, b)) +
                          base::dot(b, beam.end_force(base::opposite(pair.direction), b, a));
    change.energy -= energy;
    change.weighted_energy -= weights_.empty() ? 0 : weights_[connection] * energy;
    bounds.exact.push_back(connection);
  }
  bounds.root = std::sqrt(std::max(change.energy, 0.0) + rounding);
  bounds.weighted_root = std::sqrt(std::max(change.weighted_energy, 0.0) + rounding);
  return bounds;
}

double RatioScreen::kept_ratio(std::size_t member, std::span<const PointLoad> loads) const {
  const std::size_t connection = members_[member].connection;
  Vec force = forces_[connection];
  for (std::size_t k = 0; k < 6; ++k) {
    force[k] += kept_responses_.change(6 * member + k, loads);
  }
  return model::load_ratio(robot_.connector(robot_.connections()[connection]), force).ratio;
}

}  // namespace holdfast::plan
