// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/algebra/system.hpp"
#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/world/surroundings.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/ground_contact.hpp"

/// The mechanical state of one module, existing or planned, and what is computed on it alone.
namespace holdfast::agent {

/// How the equilibrium treats the ground, the same everywhere in the robot.
struct ContactSetting {
  mechanics::GroundFacet<double> facet;
  /// Facets act by the symmetric stand-ins of their tangents, from Node::anchor on.
  bool stands_in = false;
  double lever_mm = 0;  ///< The robot's extent: how far a force that is not balanced may reach.
};

/// A lower triangle, by rows.
using Triangle = std::array<float, 21>;

/// Loads in the middle of one connection, local frame: what Eq. (17) needs.
struct MiddleLoad {
  double axial_n = 0;
  double bending_x_nmm = 0;
  double bending_y_nmm = 0;
};

/// Six reals of a node, which mean one thing at a time.
union NodeVector {
  base::Vec6<float> sent{};  ///< What is exchanged with the neighbours.
  base::Vec6<float> load;    ///< Condensed load of a planned module that is being eliminated.
  base::Vec6<float> shift;   ///< What an exact solve, by branches or clusters, moves the node by.
};

/// A node's 6x6 matrix, as its method needs it.
union NodeMatrix {
  Triangle factor{};  ///< Cholesky factor of the diagonal block.
  Triangle
      stiffness_below;  ///< Elimination, of a planned module: its stiffness up to the diagonal.
};

/// What every method needs of one module.
struct Node {
  bool is_fixed = false;
  bool is_ground = false;
  bool is_held = true;  ///< Against slip and twist (unilateral law).
  bool was_released = false;
  bool has_changed = false;  ///< Wanted another state than was in use, at the last iteration.
  bool is_kept = false;      ///< With fronts: its facet has not held all over, and is the root's.
  mechanics::ContactState state;   ///< In use.
  mechanics::ContactState wanted;  ///< That the law prescribes for u.
  mechanics::ContactState found;   ///< When others were sought (kSeek), ...
  bool is_doubtful = false;        ///< ... and whether there may be another one.
  NodeVector vector;
  NodeMatrix matrix;
  /// Lent; null: a floor only. Else the facets have states of their own, and those above are void.
  [[no_unique_address]] PresentIf<kIsGeneral, Surroundings*> surroundings = nullptr;

  base::Vec6<double> u{};
  base::Vec6<float> anchor{};  ///< Where facets have acted by their own tangents last.
  base::Vec6<double> force{};  ///< Force of all beams on their module ends, at u.
};

/// A direction of minimal residuals: moving by p takes q from the residual, and z = M^-1 q.
struct SearchDirection {
  base::Vec6<double> p;
  base::Vec6<double> q;
  base::Vec6<double> z;
};

/// One module's vectors of minimal residuals (minimal_residuals.hpp).
struct IterationVectors {
  base::Vec6<double> w;  ///< What the polynomial leaves of the residual.
  SearchDirection older;
  SearchDirection newer;
};

/// What a method with minimal residuals keeps of a node: its vectors, or, of a planned module that
/// is condensed, the factor of what holds it.
union IterationMemory {
  IterationVectors vectors{};
  System factor;
};

/// Brings a node back to rest: no displacement, the facet stuck.
void reset(Node& node);

/// What acts on a node from outside but facets: its weight, or what its surroundings say.
base::Vec6<double> load_of(const Node& node, const Setup& setup);

/// Three columns of the diagonal block into Node::matrix, the first or (half 1) the last ones: K11
/// of the beams on `faces` and the facet's symmetric tangent.
void form_diagonal(Node& node, const Setup& setup, const ContactSetting& contact, Faces faces,
                   int half);

/// Factors what form_diagonal() has left, three rows of it.
void factor_diagonal(Node& node, int half);

/// A column of the diagonal block with the facet's tangent in use.
base::Vec6<double> diagonal_column(const Node& node, const Setup& setup,
                                   const ContactSetting& contact, Faces faces, int column);

/// Solves with the factor that factor_diagonal() has left.
base::Vec6<float> solve_diagonal(const Node& node, base::Vec6<float> vector);

/// Residual at u: load less beams less facets, in the states in use. Zero on a fixed module.
base::Vec6<double> residual(const Node& node, const Setup& setup, const ContactSetting& contact);

/// The state that the law prescribes for the facet of a node without surroundings.
mechanics::ContactState prescribed_state(const Node& node, const ContactSetting& contact);

/// How much a residual can change any load ratio: the force at the robot's full extent, and the
/// torque, carried by one connection. Rigorous where the robot is statically determinate.
double ratio_error(const base::Vec6<double>& residual, const Setup& setup,
                   const ContactSetting& contact);

}  // namespace holdfast::agent
