// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "equilibria/stuck_core.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/verdict/moved_mass.hpp"

namespace holdfast::plan {

/// How a slender robot, the core, answers to what grows on top of it.
///
/// A *section* is all modules at one number of steps from the supports, near the top. Weights that
/// come to stand above it are carried by the section's modules as a resultant R: a force straight
/// down and two moments about the section's centroid. If each module takes the part of R that the
/// theory of beams gives it, its share of a stress that is linear over the section,
///   p_i = W B_i' (sum_k B_k W B_k')^-1 R,      B_i p_i the resultant of p_i,
/// W being a module's own area and second moments of it, then three solutions for the core, one for
/// each component of R, answer to whatever comes: there s = h w but for the error of these
/// solutions. What a module really carries differs from p by forces in balance over the section.
class SectionResponse {
 public:
  using Vec = base::Vec6<double>;

  /// A force downwards and two moments.
  using Resultant = std::array<double, 3>;

  /// Takes a safe state, all of whose facets are stuck, as the core, above this section of it. None
  /// if its answers cannot be found. Keeps a reference to the robot, all modules of which are there
  /// in the end.
  static std::optional<SectionResponse> make(const model::RobotSpec& spec,
                                             const model::Robot& target, const ElementSet& state,
                                             std::vector<std::size_t> section);

  /// The section's modules, each but the first beside an earlier one.
  const std::vector<std::size_t>& modules() const { return modules_; }

  /// The resultant of loads about the origin, of which forces aside and torsion must be none.
  Resultant resultant(const Vec& load) const;

  /// The part of R that a module carries, by its place in modules(), about the origin.
  Vec share(std::size_t place, const Resultant& resultant) const;

  /// How a module of the core moves by R more.
  Vec displacement(std::size_t module, const Resultant& resultant) const;

  /// How the core's mass moves by R more; its mass is not counted.
  verdict::MovedMass moved_mass(const Resultant& resultant) const;

  /// No connection of the core gains a larger load ratio by R.
  double load_ratio(const Resultant& resultant) const;

  /// How far displacement() is off in the energy norm, at most.
  double error(const Resultant& resultant) const;

 private:
  /// The answer to one component of R.
  struct Response {
    std::vector<Vec> displacement;  ///< By module of the core.
    double error = 0;               ///< In the energy norm.
    verdict::MovedMass moved;       ///< Of all modules.
    std::array<double, 2> ratio{};  ///< The largest load ratio where the component is positive,
                                    ///< and where it is negative.
  };

  SectionResponse(const model::Robot& target, const ElementSet& state,
                  std::vector<std::size_t> section);
  void find_shares();
  double torque_weight() const;
  Vec share_at_node(std::size_t place, const Resultant& resultant) const;
  bool solve(StuckCore& core);
  void find_ratios(Response& response) const;

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  double ratio_per_norm_ = 0;
  std::vector<Element> elements_;     ///< Of the core.
  std::vector<std::int32_t> place_;   ///< By module: in elements_, or -1.
  std::vector<std::size_t> modules_;  ///< Of the section.
  Vec centroid_{};                    ///< mm; the last three are 0.
  std::vector<Vec> places_;           ///< By module: its node, mm; the last three are 0.
  std::array<double, 9> shares_{};    ///< (sum_k B_k W B_k')^-1, by rows.
  std::array<Response, 3> responses_;
};

/// A section of a robot's state, in the order of SectionResponse::modules(); empty if the state is
/// not slender, or its loads are not as SectionResponse::resultant() asks for.
std::vector<std::size_t> find_section(const model::Robot& target, const ElementSet& state);

}  // namespace holdfast::plan
