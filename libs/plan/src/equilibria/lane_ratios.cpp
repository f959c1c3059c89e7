// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/lane_ratios.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::plan {
namespace {

using base::Vec6;
using model::ConnectorLaw;
using solver::kLaneCount;
using solver::LaneBlock;

bool is_opening_only(const ConnectorLaw& law) {
  return !law.friction && std::isinf(law.shear_strength_n) &&
         std::isinf(law.torsion_strength_nmm) && law.bending == model::BendingLaw::kSquare;
}

double ratio_at(const model::Robot& robot, const model::LatticeBeam<double>& beam,
                const model::Connection& pair, const std::vector<Vec6<double>>& displacement) {
  const Vec6<double> force = beam.middle_force(pair.direction, displacement[base::at(pair.a)],
                                               displacement[base::at(pair.b)]);
  return model::load_ratio(robot.connector(pair), force).ratio;
}

}  // namespace

LaneRatios::LaneRatios(const model::Robot& robot, const solver::Influence& influence)
    : robot_(robot), influence_(influence) {
  is_opening_only_ = std::ranges::all_of(robot.connectors(), is_opening_only);
  const model::LatticeBeam<double>& beam = influence.beam();
  for (const base::Direction direction : base::directions(robot.lattice())) {
    Rows& rows = rows_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int column = static_cast<int>(k);
      rows.axial[k] = beam.middle_force(direction, base::unit<double>(column), {})[2];
      const Vec6<double> turned = beam.middle_force(direction, base::unit<double>(column + 3), {});
      rows.about_x[k] = turned[3];
      rows.about_y[k] = turned[4];
    }
  }
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const model::Connection& pair = robot.connections()[i];
    const Vec6<double> force =
        beam.middle_force(pair.direction, influence.displacement()[base::at(pair.a)],
                          influence.displacement()[base::at(pair.b)]);
    entries_.push_back({.slot_a = influence.slot(base::at(pair.a)),
                        .slot_b = influence.slot(base::at(pair.b)),
                        .connection = i,
                        .axial_n = force[2],
                        .about_x_nmm = force[3],
                        .about_y_nmm = force[4]});
  }
  error_share_ = find_error_share();
}

double LaneRatios::find_error_share() const {
  double largest = 1;
  double change = 0;
  for (const model::Connection& pair : robot_.connections()) {
    const double fine = ratio_at(robot_, influence_.beam(), pair, influence_.displacement());
    const double rough = ratio_at(robot_, influence_.beam(), pair, influence_.rough_displacement());
    if (std::isnan(fine) || std::isnan(rough)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    largest = std::max(largest, std::abs(fine));
    change = std::max(change, std::abs(fine - rough));
  }
  return change / largest;
}

LaneRatios::PerLane LaneRatios::largest(std::span<const LaneBlock> more) const {
  PerLane largest;
  largest.fill(-std::numeric_limits<double>::infinity());
  for (const Entry& entry : entries_) {
    if (is_opening_only_) {
      add_opening(entry, more, largest);
    } else {
      add_general(entry, more, largest);
    }
  }
  return largest;
}

/// (N + max(|mx|, |my|) / lever) / strength
void LaneRatios::add_opening(const Entry& entry, std::span<const LaneBlock> more,
                             PerLane& largest) const {
  const model::Connection& pair = robot_.connections()[entry.connection];
  const ConnectorLaw& law = robot_.connector(pair);
  const Rows& rows = rows_[static_cast<std::size_t>(base::index(pair.direction))];
  const LaneBlock& a = more[entry.slot_a];
  const LaneBlock& b = more[entry.slot_b];
  const double per_force = 1 / law.strength_n;
  const double per_moment = per_force / law.lever_mm;
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
    double axial = entry.axial_n;
    double about_x = entry.about_x_nmm;
    double about_y = entry.about_y_nmm;
    for (std::size_t k = 0; k < 3; ++k) {
      axial += rows.axial[k] * (a.values[k][lane] - b.values[k][lane]);
      const double turned = a.values[k + 3][lane] - b.values[k + 3][lane];
      about_x += rows.about_x[k] * turned;
      about_y += rows.about_y[k] * turned;
    }
    about_x = std::abs(about_x);
    about_y = std::abs(about_y);
    const double ratio = per_force * axial + per_moment * (about_x > about_y ? about_x : about_y);
    largest[lane] = ratio > largest[lane] ? ratio : largest[lane];
  }
}

void LaneRatios::add_general(const Entry& entry, std::span<const LaneBlock> more,
                             PerLane& largest) const {
  const model::Connection& pair = robot_.connections()[entry.connection];
  const ConnectorLaw& law = robot_.connector(pair);
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
    Vec6<double> a = influence_.displacement()[base::at(pair.a)];
    Vec6<double> b = influence_.displacement()[base::at(pair.b)];
    for (std::size_t k = 0; k < 6; ++k) {
      a[k] += more[entry.slot_a].values[k][lane];
      b[k] += more[entry.slot_b].values[k][lane];
    }
    const double ratio =
        model::load_ratio(law, influence_.beam().middle_force(pair.direction, a, b)).ratio;
    largest[lane] = ratio > largest[lane] ? ratio : largest[lane];
  }
}

}  // namespace holdfast::plan
