// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/host/ranks.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/model/loads.hpp"
#include "holdfast/model/robot.hpp"
#include "multigrid/coarsening/reduced_network.hpp"

/// Static condensation: what the modules that a ReducedNetwork has eliminated do to its nodes, and
/// how they follow these.
///
/// With e the eliminated modules and n the nodes the equations of a robot are
///   [K_ee K_en] [u_e]   [f_e]          K' u_n = f_n - K_ne K_ee^-1 f_e
///   [K_ne K_nn] [u_n] = [f_n]    =>    u_e    = K_ee^-1 f_e - K_ee^-1 K_en u_n
/// K' is that of the longer beams; -K_ne K_ee^-1 moves loads along levers and by Hermite's cubics
/// (beam_shapes.hpp), and its transpose moves modules with the nodes. What is left is the
/// flexibility K_ee^-1, run by run.
namespace holdfast::solver {

/// Loads by module, kept where they are not the robot's own: most nodes carry nothing but those.
class CondensedLoads {
 public:
  using Load = base::Vec6<double>;

  CondensedLoads() = default;

  /// Keeps of loads by module those that differ from the robot's `own`.
  CondensedLoads(const std::vector<Load>& loads, const model::Loads& own);

  /// The load of a module; `own` are the same robot's as before.
  const Load& of(std::size_t module, const model::Loads& own) const {
    const bool is_kept = !marks_.empty() && (marks_[module / kBits] >> module % kBits & 1U) != 0;
    return is_kept ? kept_[place_of(module)] : own[module];
  }

 private:
  static constexpr std::size_t kBits = 64;

  /// How many are kept of the modules before.
  std::size_t place_of(std::size_t module) const {
    const std::uint64_t before =
        marks_[module / kBits] & ((std::uint64_t{1} << module % kBits) - 1);
    return before_[module / kBits] + static_cast<std::size_t>(std::popcount(before));
  }

  std::vector<std::uint64_t> marks_;   ///< A bit for each module, set if its load is kept.
  std::vector<std::uint32_t> before_;  ///< How many bits are set before each of these numbers.
  std::vector<Load> kept_;             ///< By module.
};

/// The loads on a reduced network, by module: of nodes f_n - K_ne K_ee^-1 f_e, of eliminated
/// modules K_ee^-1 f_e, how far the loads move them while their run's ends, or their hosts,
/// are held. Of a part of a robot `copies` keeps those of modules up to date: a tree that crosses
/// ranks hands its load on round by round, from the leaves on.
CondensedLoads condense(const model::Robot& robot, const ReducedNetwork& network, host::Team& team,
                        const model::Loads& loads, host::Halo& copies);

/// Fills in the displacements of eliminated modules, those of nodes being given, by module; with
/// the loads that condense() made of `loads`. Across ranks from the roots of trees to their leaves.
void recover(const model::Robot& robot, const ReducedNetwork& network, host::Team& team,
             const model::Loads& loads, const CondensedLoads& condensed,
             std::vector<base::Vec6<double>>& displacement, host::Halo& copies);

}  // namespace holdfast::solver
