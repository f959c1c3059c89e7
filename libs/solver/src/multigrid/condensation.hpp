// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/host/ranks.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/model/loads.hpp"
#include "holdfast/model/robot.hpp"
#include "reduced_network.hpp"

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

/// The loads on a reduced network, by module: of nodes f_n - K_ne K_ee^-1 f_e, of eliminated
/// modules K_ee^-1 f_e, how far the loads move them while their run's ends, or what they hang on,
/// are held. Of a part of a robot `copies` keeps those of modules up to date: a tree that crosses
/// ranks hands its load on round by round, from the leaves on.
std::vector<base::Vec6<double>> condense(const model::Robot& robot, const ReducedNetwork& network,
                                         host::Team& team, const model::Loads& loads,
                                         host::Halo* copies = nullptr);

/// Fills in the displacements of eliminated modules, those of nodes being given, by module; with
/// the loads that condense() returned. Across ranks from what trees hang on to their leaves.
void recover(const model::Robot& robot, const ReducedNetwork& network, host::Team& team,
             const std::vector<base::Vec6<double>>& condensed,
             std::vector<base::Vec6<double>>& displacement, host::Halo* copies = nullptr);

}  // namespace holdfast::solver
