// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/section_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bounds/robot_growth.hpp"
#include "dense.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

/// A slender robot has no more modules than that at any number of steps from its supports.
constexpr std::size_t kSectionMax = 16;

/// Below the section there are at least so many steps; ways down that are shorter cost little.
constexpr std::size_t kStepsMin = 12;

/// The section lies so many steps below the top, where not all modules of a layer need be there.
constexpr std::size_t kStepsBelowTop = 1;

/// Of the solutions, of their own energy norm: a thousandth of what the core moves by.
constexpr double kSectionTolerance = 3e-4;

}  // namespace

SectionResponse::SectionResponse(const model::RobotSpec& spec, const model::Robot& target)
    : spec_(spec),
      target_(target),
      beam_(model::beam_section(target.material()), target.lattice()),
      ratio_per_norm_(model::load_ratio_per_energy_norm(target)),
      is_support_(target.modules().size()) {
  for (const model::Facet& facet : target.facets()) {
    is_support_[at(facet.module)] = true;
  }
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    is_support_[i] = is_support_[i] || target.modules()[i].support == model::Support::kFixed;
    places_.push_back(node_place(target, i));
    const Vec& load = target.loads()[i];
    is_plain_ = is_plain_ && load[0] == 0 && load[1] == 0 && load[5] == 0;
  }
}

bool SectionResponse::find(const ElementSet& state) {
  if (!is_plain_) {
    return false;
  }
  elements_ = state.elements();
  place_.assign(target_.modules().size(), -1);
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    place_[at(elements_[i])] = static_cast<std::int32_t>(i);
  }
  return find_section();
}

/// Layer by layer from the supports, as long as each is small.
bool SectionResponse::find_section() {
  std::vector<std::vector<std::size_t>> layers(1);
  std::vector<bool> is_reached(target_.modules().size());
  for (const Element element : elements_) {
    if (is_support_[at(element)]) {
      is_reached[at(element)] = true;
      layers.front().push_back(at(element));
    }
  }
  while (!layers.back().empty()) {
    if (layers.back().size() > kSectionMax) {
      return false;
    }
    std::vector<std::size_t> next;
    for (const std::size_t module : layers.back()) {
      for (const std::int32_t other : target_.connected()[module]) {
        if (other != model::Robot::kNoNeighbour && place_[at(other)] >= 0 &&
            !is_reached[at(other)]) {
          is_reached[at(other)] = true;
          next.push_back(at(other));
        }
      }
    }
    layers.push_back(std::move(next));
  }
  layers.pop_back();
  if (layers.size() <= kStepsMin + kStepsBelowTop) {
    return false;
  }
  modules_ = layers[layers.size() - 1 - kStepsBelowTop];
  return put_in_order();
}

/// Each but the first beside an earlier one. False if they do not hang together.
bool SectionResponse::put_in_order() {
  for (std::size_t i = 1; i < modules_.size(); ++i) {
    const auto is_beside = [&](std::size_t module) {
      return std::ranges::any_of(target_.connected()[module], [&](std::int32_t other) {
        const auto end = modules_.begin() + static_cast<std::ptrdiff_t>(i);
        return other != model::Robot::kNoNeighbour &&
               std::find(modules_.begin(), end, at(other)) != end;
      });
    };
    const auto rest = modules_.begin() + static_cast<std::ptrdiff_t>(i);
    const auto next = std::find_if(rest, modules_.end(), is_beside);
    if (next == modules_.end()) {
      return false;
    }
    std::iter_swap(rest, next);
  }
  return true;
}

/// W is 1 for the force, and what a square of that area has for the moments.
void SectionResponse::find_shares() {
  centroid_ = {};
  for (const std::size_t module : modules_) {
    base::add_to(centroid_, places_[module]);
  }
  for (double& value : centroid_) {
    value /= static_cast<double>(modules_.size());
  }
  DenseSystem system(3);
  for (const std::size_t module : modules_) {
    const double x = places_[module][0] - centroid_[0];
    const double y = places_[module][1] - centroid_[1];
    const Resultant row = {1, y, -x};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        system.at(i, k) += row[i] * row[k] + (i == k && i > 0 ? torque_weight() : 0.0);
      }
    }
  }
  HOLDFAST_CHECK(system.factor());
  for (std::size_t k = 0; k < 3; ++k) {
    Resultant column{};
    column[k] = 1;
    system.solve(column);
    for (std::size_t i = 0; i < 3; ++i) {
      shares_[3 * i + k] = column[i];
    }
  }
}

double SectionResponse::torque_weight() const {
  const double pitch = target_.material().pitch_mm;
  return pitch * pitch / 12;
}

SectionResponse::Resultant SectionResponse::resultant(const Vec& load) const {
  return {load[2], load[3] - centroid_[1] * load[2], load[4] + centroid_[0] * load[2]};
}

SectionResponse::Vec SectionResponse::share_at_node(std::size_t place,
                                                    const Resultant& resultant) const {
  Resultant factor{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      factor[i] += shares_[3 * i + k] * resultant[k];
    }
  }
  const Vec& node = places_[modules_[place]];
  const double x = node[0] - centroid_[0];
  const double y = node[1] - centroid_[1];
  return {0,
          0,
          factor[0] + y * factor[1] - x * factor[2],
          torque_weight() * factor[1],
          torque_weight() * factor[2],
          0};
}

SectionResponse::Vec SectionResponse::share(std::size_t place, const Resultant& resultant) const {
  const Vec& node = places_[modules_[place]];
  return force_at(share_at_node(place, resultant), {-node[0], -node[1], -node[2], 0, 0, 0});
}

SectionResponse::Vec SectionResponse::displacement(std::size_t module,
                                                   const Resultant& resultant) const {
  Vec sum{};
  for (std::size_t k = 0; k < 3; ++k) {
    base::add_times(sum, resultant[k], responses_[k].displacement[at(place_[module])]);
  }
  return sum;
}

verdict::MovedMass SectionResponse::moved_mass(const Resultant& resultant) const {
  verdict::MovedMass sum;
  for (std::size_t k = 0; k < 3; ++k) {
    sum.x_kg_mm += resultant[k] * responses_[k].moved.x_kg_mm;
    sum.y_kg_mm += resultant[k] * responses_[k].moved.y_kg_mm;
  }
  return sum;
}

double SectionResponse::load_ratio(const Resultant& resultant) const {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += std::abs(resultant[k]) * responses_[k].ratio[resultant[k] < 0 ? 1 : 0];
  }
  return sum;
}

double SectionResponse::error(const Resultant& resultant) const {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += std::abs(resultant[k]) * responses_[k].error;
  }
  return sum;
}

/// In single precision, or where the core is too slender for it in double.
bool SectionResponse::solve() {
  find_shares();
  ElementSet state(target_.modules().size());
  for (const Element element : elements_) {
    state.insert(element);
  }
  const auto robot = model::Robot::create(part_of(spec_, state), 1);
  if (!robot) {
    return false;
  }
  return std::ranges::any_of(
      std::array{solver::Precision::kSingle, solver::Precision::kDouble},
      [&](solver::Precision precision) { return solve(robot.value(), precision); });
}

bool SectionResponse::solve(const model::Robot& core, solver::Precision precision) {
  const auto system = solver::make_linear_system(core, {.precision = precision, .thread_count = 1});
  if (!system) {
    return false;
  }
  system->set_law({});
  for (std::size_t k = 0; k < 3; ++k) {
    Resultant unit{};
    unit[k] = 1;
    std::vector<Vec> loads(elements_.size());
    for (std::size_t i = 0; i < modules_.size(); ++i) {
      loads[at(place_[modules_[i]])] = share_at_node(i, unit);
    }
    system->set_loads(model::Loads(loads));
    if (system->solve(kSectionTolerance) != solver::LinearOutcome::kSolved) {
      return false;
    }
    Response& response = responses_[k];
    response.displacement = system->displacement();
    response.moved = {};
    double work = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const Vec& u = response.displacement[i];
      response.moved.add(core.mass(i), u[0], u[1]);
      work += base::dot(loads[i], u);
    }
    response.error = system->is_exact() ? 0
                                        : verdict::kEnergyFactor * kSectionTolerance *
                                              std::sqrt(std::max(0.0, work));
    find_ratios(response);
  }
  return true;
}

/// With the error of the solution.
void SectionResponse::find_ratios(Response& response) const {
  response.ratio = {};
  for (const Element element : elements_) {
    for (const Direction direction : base::directions(target_.lattice())) {
      const std::int32_t other = target_.connected()[at(element)][at(base::index(direction))];
      if (base::index(direction) % 2 != 0 || other == model::Robot::kNoNeighbour ||
          place_[at(other)] < 0) {
        continue;
      }
      Vec force = beam_.middle_force(direction, response.displacement[at(place_[at(element)])],
                                     response.displacement[at(place_[at(other)])]);
      for (double& ratio : response.ratio) {
        ratio = std::max(ratio, connection_ratio(target_, at(element), at(other),
                                                 base::index(direction), force));
        for (double& value : force) {
          value = -value;
        }
      }
    }
  }
  for (double& ratio : response.ratio) {
    ratio += ratio_per_norm_ * response.error;
  }
}

}  // namespace holdfast::plan
