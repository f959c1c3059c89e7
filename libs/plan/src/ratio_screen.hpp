// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/solver/influence.hpp"
#include "responses.hpp"

namespace holdfast::plan {

/// Loads f that are added to a robot's own, and bounds of what they do to it. The energy of a
/// connection is u' K_e u under their displacements u = K^-1 f, twice what it stores.
struct LoadChange {
  std::span<const PointLoad> loads = {};
  double energy = 0;  ///< f' K^-1 f, of all connections and facets together.
  /// Of all connections, each by its weight (RatioScreen::weights()), or more.
  double weighted_energy = std::numeric_limits<double>::infinity();
};

/// The largest load ratio of a robot's connections under a change of its loads, from bounds of the
/// rest where few connections decide: the energy of a connection bounds its force. Load ratios are
/// convex and grow with the force, so that of a sum is no more than the sum of both. Keeps
/// references.
class RatioScreen {
 public:
  using Vec = base::Vec6<double>;

  /// For a robot that moves by `displacement` before the change.
  RatioScreen(const model::Robot& robot, const solver::Influence& influence,
              const std::vector<Vec>& displacement);

  double ratio_max() const { return ratio_max_; }

  /// Finds what loads on any module do to the connections with the largest load ratios, as many as
  /// pay: six solutions for each, one for every change that bounds do not decide. `energies` is a
  /// sample of so many changes after which the largest ratio is `target` or more.
  void keep_columns(double target, std::span<const double> energies, std::size_t change_count);

  /// A weight for every connection by which the energy is to be summed up besides, at most 1: less
  /// for those that are pressed together. For candidates whose load ratio is about `target`.
  std::vector<double> weights(double target) const;
  void set_weights(std::vector<double> weights);

  /// The largest load ratio, `known` included. None if bounds do not tell.
  std::optional<double> largest(const LoadChange& change, double known) const;

 private:
  /// A connection: its load ratio before the change, and by how much one unit of the root of its
  /// energy may raise it.
  struct Member {
    std::size_t connection = 0;
    double ratio = 0;
    double rise = 0;
    double weighted_rise = std::numeric_limits<double>::infinity();
  };

  /// The bounds of several members in a row.
  struct Group {
    double ratio = 0;
    double rise = 0;
    double weighted_rise = 0;
  };

  /// Energies that bound every connection but some beside a host, whose load ratios are known.
  struct Bounds {
    double root = 0;
    double weighted_root = 0;
    double known = 0;
    std::vector<std::size_t> exact = {};  ///< Connections.
  };

  void make_groups();
  double kept_ratio(std::size_t member, std::span<const PointLoad> loads) const;
  bool is_below(const Bounds& bounds) const;
  Bounds beside_host(const PointLoad& load, LoadChange change, double known) const;

  const model::Robot& robot_;
  const solver::Influence& influence_;
  double ratio_max_ = 0;
  double rise_max_ = 0;
  std::vector<Member> members_;  ///< By descending ratio.
  std::vector<Group> groups_;
  std::size_t kept_count_ = 0;   ///< The first so many members have columns.
  Responses kept_responses_;     ///< Of each component of their forces.
  std::vector<Vec> forces_;      ///< In the middle, before the change; by connection.
  std::vector<double> weights_;  ///< By connection; empty: none.
  std::vector<std::vector<std::size_t>> beside_;  ///< A module's connections.
};

}  // namespace holdfast::plan
