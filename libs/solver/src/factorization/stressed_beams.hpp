// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/model/large_beams.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/linear_system.hpp"

namespace holdfast::solver {

/// The geometric stiffness K_G of a robot's beams and facets under the stresses of displacements
/// u1, to which it keeps a reference, as to the system.
class StressedBeams {
 public:
  using Vec = base::Vec6<double>;
  using Vecs = std::vector<Vec>;

  StressedBeams(const LinearSystem& system, const Vecs& displacement, int thread_count);

  const LinearSystem& system() const { return system_; }

  /// The beams by direction.
  const model::LargeBeams& beams() const { return beams_; }

  /// The stresses of a connection, and of a facet in its state.
  Vec stress(const model::Connection& connection) const;
  Vec facet_stress(std::size_t facet) const;

  /// The blocks of a connection.
  mechanics::EndTangent blocks(const model::Connection& connection);

  /// The block of a facet, which stands on the diagonal.
  base::Mat6<double> block(std::size_t facet);

  /// -K_G x, by module; what fixed modules would take is zero.
  Vecs softening(const Vecs& x);

  /// The part of second order of the forces at u1, by module; zero for fixed modules.
  Vecs second_order_forces();

  /// K x by module, beam by beam.
  Vecs stiffness_times(const Vecs& x);

 private:
  using Bases = std::array<mechanics::EndTangent, 6>;  ///< For unit stresses.

  const model::Robot& robot() const { return system_.robot(); }

  /// The blocks of a direction, made when they are first asked for, which no two threads may do.
  const Bases& bases(base::Direction direction);

  template <class OnPair>
  Vecs sum_over_neighbours(const OnPair& on_pair);

  template <class OnPair>
  Vecs sum_over_beams(const OnPair& on_pair);

  const LinearSystem& system_;
  const Vecs& displacement_;
  host::Team team_;
  model::LargeBeams beams_;
  /// Blocks by direction.
  std::array<std::unique_ptr<const Bases>, base::Lattice::kDirectionCountMax + 1> bases_;
};

}  // namespace holdfast::solver
