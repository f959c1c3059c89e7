// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/section_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "dense.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/model/material.hpp"

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

/// The tolerance of solutions, of their own energy norm: a thousandth of what the core moves by.
constexpr double kSectionTolerance = 3e-4;

/// Whether no load pulls aside or twists.
bool pulls_straight_down(const model::Robot& target) {
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    const Vec6<double>& load = target.loads()[i];
    if (load[0] != 0 || load[1] != 0 || load[5] != 0) {
      return false;
    }
  }
  return true;
}

/// Each but the first is beside an earlier one; empty if they are not connected.
std::vector<std::size_t> in_order(const model::Robot& target, std::vector<std::size_t> modules) {
  for (auto rest = modules.begin() + 1; rest != modules.end(); ++rest) {
    const auto is_beside = [&](std::size_t module) {
      return std::ranges::any_of(target.connected()[module], [&](std::int32_t other) {
        return other != model::Robot::kNoNeighbour &&
               std::find(modules.begin(), rest, at(other)) != rest;
      });
    };
    const auto next = std::find_if(rest, modules.end(), is_beside);
    if (next == modules.end()) {
      return {};
    }
    std::iter_swap(rest, next);
  }
  return modules;
}

}  // namespace

/// Looks layer by layer from the supports, as long as each is small.
std::vector<std::size_t> find_section(const model::Robot& target, const ElementSet& state) {
  if (!pulls_straight_down(target)) {
    return {};
  }
  std::vector<std::vector<std::size_t>> layers(1);
  std::vector<bool> is_reached(target.modules().size());
  for (const Element element : state.elements()) {
    if (target.modules()[at(element)].support != model::Support::kNone) {
      is_reached[at(element)] = true;
      layers.front().push_back(at(element));
    }
  }
  while (!layers.back().empty()) {
    if (layers.back().size() > kSectionMax) {
      return {};
    }
    std::vector<std::size_t> next;
    for (const std::size_t module : layers.back()) {
      for (const std::int32_t other : target.connected()[module]) {
        if (other != model::Robot::kNoNeighbour && state.contains(other) &&
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
    return {};
  }
  return in_order(target, layers[layers.size() - 1 - kStepsBelowTop]);
}

SectionResponse::SectionResponse(const model::Robot& target, const ElementSet& state,
                                 std::vector<std::size_t> section)
    : target_(&target),
      beam_(model::beam_section(target.material()), target.lattice()),
      ratio_per_norm_(model::load_ratio_per_energy_norm(target)),
      elements_(state.elements()),
      place_(target.modules().size(), -1),
      modules_(std::move(section)) {
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    place_[at(elements_[i])] = static_cast<std::int32_t>(i);
  }
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    places_.push_back(node_place(target, i));
  }
  find_shares();
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
  const double pitch = target_->material().pitch_mm;
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

/// Solves in single precision, or in double where the core is too slender for that.
std::optional<SectionResponse> SectionResponse::make(const model::RobotSpec& spec,
                                                     const model::Robot& target,
                                                     const ElementSet& state,
                                                     std::vector<std::size_t> section) {
  SectionResponse response(target, state, std::move(section));
  for (const auto precision : {solver::Precision::kSingle, solver::Precision::kDouble}) {
    const auto core = StuckCore::make(spec, state, precision);
    if (core && response.solve(*core)) {
      return response;
    }
  }
  return std::nullopt;
}

bool SectionResponse::solve(StuckCore& core) {
  for (std::size_t k = 0; k < 3; ++k) {
    Resultant unit{};
    unit[k] = 1;
    std::vector<Vec> loads(elements_.size());
    for (std::size_t i = 0; i < modules_.size(); ++i) {
      loads[at(place_[modules_[i]])] = share_at_node(i, unit);
    }
    auto answer = core.answer(loads, kSectionTolerance);
    if (!answer) {
      return false;
    }
    Response& response = responses_[k];
    response.displacement = std::move(answer->displacement);
    response.error = answer->error;
    response.moved = {};
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const Vec& u = response.displacement[i];
      response.moved.add(core.robot().mass(i), u[0], u[1]);
    }
    find_ratios(response);
  }
  return true;
}

/// Finds the largest load ratios by R and by -R, with the error of the solution.
void SectionResponse::find_ratios(Response& response) const {
  response.ratio = {};
  for (const Element element : elements_) {
    for (const Direction direction : base::directions(target_->lattice())) {
      const std::int32_t other = target_->connected()[at(element)][at(base::index(direction))];
      if (base::index(direction) % 2 != 0 || other == model::Robot::kNoNeighbour ||
          place_[at(other)] < 0) {
        continue;
      }
      Vec force = beam_.middle_force(direction, response.displacement[at(place_[at(element)])],
                                     response.displacement[at(place_[at(other)])]);
      for (double& ratio : response.ratio) {
        ratio = std::max(ratio, connection_ratio(*target_, at(element), at(other),
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
