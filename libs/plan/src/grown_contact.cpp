// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "grown_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dense.hpp"
#include "holdfast/solver/second_state.hpp"
#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::plan {
namespace {

using base::Mat6;
using base::Vec6;
using mechanics::ContactState;
using solver::FacetState;

/// Steps of Newton's path, as many as the solver's.
constexpr std::size_t kStepCountMax = 100;

/// Trial forces nearer than this share to another state may be looked up otherwise by a check,
/// which rounds otherwise.
constexpr double kStateShare = 1e-8;
constexpr double kStateRounding = 1e-12;

/// By which a facet's sideways force may be off where only its size decides.
constexpr double kForceShare = 1e-6;

std::vector<base::Direction> directions_of(const Site& site) {
  std::vector<base::Direction> directions;
  for (const Link& link : site.links) {
    directions.push_back(link.direction);
  }
  return directions;
}

/// Whether the robot is on a flat floor, or would be with a module on one.
bool stands_flat(const model::Robot& robot) {
  const auto& [x, y, z] = robot.gravity();
  return robot.facets().empty() ? x == 0 && y == 0 && z < 0 && !robot.has_payloads()
                                : verdict::is_on_flat_floor(robot);
}

Vec6<double> scaled(const Vec6<double>& a, const Vec6<double>& b) {
  Vec6<double> product{};
  for (std::size_t k = 0; k < 6; ++k) {
    product[k] = a[k] * b[k];
  }
  return product;
}

}  // namespace

/// The unknowns are t of every host, if the new node is more than a load, and the forces a on the
/// rows of facets that yield; the outputs are what these depend on, the hosts' displacements y and
/// the yielding facets' motions w, both linear in the unknowns s:
///   outputs = known + G s,   t = q - C y,   a = -(corrector - 1) H w.
class GrownContact::System {
 public:
  System(const GrownContact& contact, const Site& site, const NewNode& node,
         const FacetInfluence* facets, const States& states)
      : contact_(contact), site_(site), node_(node), facets_(facets) {
    for (std::size_t i = 0; facets != nullptr && i < contact.influence_.facets().size(); ++i) {
      if (states[i] != mechanics::kStuck) {
        add_facet(i, states[i]);
      }
    }
    if (!node.is_load()) {
      take_hosts();
    } else if (!site.links.empty()) {
      known_.push_back({.module = site.links.front().host, .load = node.load(0)});
    }
  }

  /// False if it is singular.
  [[nodiscard]] bool solve() {
    const std::size_t size = host_unknowns() + rows_.size();
    values_.assign(size, 0);
    if (size == 0) {
      return true;
    }
    DenseSystem system(size);
    for (std::size_t column = 0; column < size; ++column) {
      const std::vector<double> image = unknowns_of(outputs_of(column));
      for (std::size_t row = 0; row < size; ++row) {
        system.at(row, column) = (row == column ? 1 : 0) - image[row];
      }
    }
    std::vector<double> right = unknowns_of(known_outputs());
    for (std::size_t i = 0; i < host_unknowns(); ++i) {
      right[i] += node_.load(i / 6)[i % 6];
    }
    if (!system.factor()) {
      return false;
    }
    system.solve(right);
    values_ = std::move(right);
    return true;
  }

  Step step() const {
    Step step;
    for (std::size_t h = 0; h < site_.links.size(); ++h) {
      Vec load = node_.load(h);
      for (std::size_t k = 0; !node_.is_load() && k < 6; ++k) {
        load[k] = values_[6 * h + k];
      }
      step.host_loads.push_back(load);
    }
    if (!rows_.empty()) {
      step.facet_forces.resize(contact_.influence_.facets().size());
    }
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const auto [place, component] = rows_[r];
      step.facet_forces[yielding_[place].facet][component] = values_[host_unknowns() + r];
    }
    if (facets_ != nullptr) {
      take_motions(step);
    }
    return step;
  }

 private:
  struct Yielding {
    std::size_t facet = 0;
    Mat6<double> matrix;  ///< (corrector - 1) H
  };

  struct Row {
    std::size_t place = 0;  ///< Among those that yield.
    std::size_t component = 0;
  };

  /// By host, then by yielding facet.
  using Outputs = std::vector<Vec>;

  std::size_t host_unknowns() const { return node_.is_load() ? 0 : 6 * site_.links.size(); }

  std::size_t host_outputs() const { return host_unknowns() / 6; }

  void add_facet(std::size_t facet, const ContactState& state) {
    const auto& ground = contact_.influence_.law().ground();
    Yielding yielding{.facet = facet, .matrix = mechanics::corrector(ground, state, true)};
    for (int row = 0; row < 6; ++row) {
      yielding.matrix.at(row, row) -= 1;
      bool is_changed = false;
      for (int column = 0; column < 6; ++column) {
        yielding.matrix.at(row, column) *= ground.stiffness[static_cast<std::size_t>(column)];
        is_changed = is_changed || yielding.matrix.at(row, column) != 0;
      }
      if (is_changed) {
        rows_.push_back({.place = yielding_.size(), .component = static_cast<std::size_t>(row)});
      }
    }
    yielding_.push_back(yielding);
  }

  void take_hosts() {
    const std::size_t count = site_.links.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        between_hosts_.push_back(
            contact_.influence_.between(site_.links[i].host, site_.links[j].host));
        stiffness_.push_back(node_.stiffness(i, j));
      }
    }
  }

  /// Outputs without any unknown force.
  Outputs known_outputs() const {
    const auto& displacement = contact_.influence_.displacement();
    Outputs outputs;
    for (std::size_t h = 0; h < host_outputs(); ++h) {
      outputs.push_back(displacement[site_.links[h].host]);
    }
    for (const Yielding& yielding : yielding_) {
      outputs.push_back(known_motion(yielding.facet));
    }
    return outputs;
  }

  /// w of a facet without any unknown force.
  Vec known_motion(std::size_t facet) const {
    const std::size_t module = contact_.influence_.facets()[facet].module;
    Vec w = facets_->motion(facet, contact_.influence_.displacement()[module]);
    for (const PointLoad& known : known_) {
      add_host_load(w, facet, known.module, known.load);
    }
    return w;
  }

  void add_host_load(Vec& w, std::size_t facet, std::size_t host, const Vec& load) const {
    for (std::size_t i = 0; i < 6; ++i) {
      w[i] += base::dot(facets_->displacement(host, facet, i), load);
    }
  }

  /// Outputs of one unit of one unknown.
  Outputs outputs_of(std::size_t unknown) const {
    Outputs outputs(host_outputs() + yielding_.size());
    if (unknown < host_unknowns()) {
      const std::size_t host = unknown / 6;
      const Vec unit = base::unit<double>(static_cast<int>(unknown % 6));
      for (std::size_t h = 0; h < host_outputs(); ++h) {
        outputs[h] = base::multiply(between_hosts_[h * host_outputs() + host], unit);
      }
      for (std::size_t i = 0; i < yielding_.size(); ++i) {
        add_host_load(outputs[host_outputs() + i], yielding_[i].facet, site_.links[host].host,
                      unit);
      }
      return outputs;
    }
    const auto [place, component] = rows_[unknown - host_unknowns()];
    const std::size_t facet = yielding_[place].facet;
    for (std::size_t h = 0; h < host_outputs(); ++h) {
      outputs[h] = facets_->displacement(site_.links[h].host, facet, component);
    }
    for (std::size_t i = 0; i < yielding_.size(); ++i) {
      outputs[host_outputs() + i] = base::multiply(facets_->between(yielding_[i].facet, facet),
                                                   base::unit<double>(static_cast<int>(component)));
    }
    return outputs;
  }

  /// -C y and -(corrector - 1) H w.
  std::vector<double> unknowns_of(const Outputs& outputs) const {
    std::vector<double> unknowns(host_unknowns() + rows_.size());
    for (std::size_t i = 0; i < host_outputs(); ++i) {
      for (std::size_t j = 0; j < host_outputs(); ++j) {
        const Vec force = base::multiply(stiffness_[i * host_outputs() + j], outputs[j]);
        for (std::size_t k = 0; k < 6; ++k) {
          unknowns[6 * i + k] -= force[k];
        }
      }
    }
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const auto [place, component] = rows_[r];
      const Vec& w = outputs[host_outputs() + place];
      for (int k = 0; k < 6; ++k) {
        unknowns[host_unknowns() + r] -=
            yielding_[place].matrix.at(static_cast<int>(component), k) *
            w[static_cast<std::size_t>(k)];
      }
    }
    return unknowns;
  }

  void take_motions(Step& step) const {
    for (std::size_t i = 0; i < contact_.influence_.facets().size(); ++i) {
      Vec w = known_motion(i);
      for (std::size_t h = 0; h < host_outputs(); ++h) {
        add_host_load(w, i, site_.links[h].host, step.host_loads[h]);
      }
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const auto [place, component] = rows_[r];
        const Mat6<double>& between = facets_->between(i, yielding_[place].facet);
        for (std::size_t k = 0; k < 6; ++k) {
          w[k] += between.values[6 * component + k] * values_[host_unknowns() + r];
        }
      }
      step.motions.push_back(w);
    }
    if (site_.is_on_floor) {
      step.motions.push_back(contact_.own_motion(node_.displacement(host_displacements())));
    }
  }

  std::vector<Vec> host_displacements() const {
    Outputs y = known_outputs();
    y.resize(host_outputs());
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const Outputs part = outputs_of(i);
      for (std::size_t h = 0; h < y.size(); ++h) {
        base::add_times(y[h], values_[i], part[h]);
      }
    }
    return y;
  }

  const GrownContact& contact_;
  const Site& site_;
  const NewNode& node_;
  const FacetInfluence* facets_;
  std::vector<PointLoad> known_;
  std::vector<Yielding> yielding_;
  std::vector<Row> rows_;
  std::vector<Mat6<double>> between_hosts_;
  std::vector<Mat6<double>> stiffness_;
  std::vector<double> values_;
};

GrownContact::GrownContact(const model::Robot& robot, const model::Touch& floor,
                           const solver::Influence& influence, bool is_bonded,
                           std::span<const Site> sites)
    : robot_(robot),
      influence_(influence),
      is_bonded_(is_bonded),
      is_flat_(stands_flat(robot)),
      is_held_(robot.fixed_count() > 0 || robot.has_bonded_facets()),
      floor_(floor) {
  const double mass = robot.kinds().front().mass_kg;
  double total = mass;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    total += robot.mass(i);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    load_[k] = mass * robot.gravity()[k];
    scale_n_ += total * std::abs(robot.gravity()[k]);
  }
  for (const Site& site : sites) {
    const std::vector<base::Direction> directions = directions_of(site);
    for (int code = 0; site.is_on_floor && code < ContactState::kCodeCount; ++code) {
      const FacetState facet = own_facet(ContactState::from_code(code));
      nodes_.try_emplace(std::pair(directions, code), influence_, site, load_, &facet);
    }
    if (!site.is_on_floor) {
      nodes_.try_emplace(std::pair(directions, -1), influence_, site, load_, nullptr);
    }
  }
  nodes_.try_emplace(std::pair(std::vector<base::Direction>{}, -1));
}

FacetState GrownContact::own_facet(const ContactState& state) const {
  return {.module = 0,
          .direction = base::down(robot_.lattice()),
          .is_bonded = floor_.hold == model::Hold::kBonded,
          .state = state};
}

const NewNode& GrownContact::node(const Site& site, const ContactState& own) const {
  return nodes_.at({directions_of(site), site.is_on_floor ? own.code() : -1});
}

Vec6<double> GrownContact::own_motion(const Vec& u) const {
  Vec w = influence_.law().trial_force(own_facet({}), u);
  for (std::size_t k = 0; k < 6; ++k) {
    w[k] /= influence_.law().ground().stiffness[k];
  }
  return w;
}

std::optional<GrownContact::Step> GrownContact::solve(const Site& site, const NewNode& node,
                                                      const FacetInfluence* facets,
                                                      const States& states) const {
  System system(*this, site, node, facets, states);
  return system.solve() ? std::optional(system.step()) : std::nullopt;
}

/// The state for a trial force; none if the next digits could change it.
std::optional<ContactState> GrownContact::certain_state(const FacetState& facet,
                                                        const Vec& trial) const {
  const auto& ground = influence_.law().ground();
  double force = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    force += std::abs(trial[k]) + std::abs(trial[k + 3]) / ground.lever;
  }
  const double error = kStateShare * force + kStateRounding * scale_n_;
  Vec more = trial;
  Vec less = trial;
  more[2] -= error;
  less[2] += error;
  const ContactState state = influence_.law().state_for(facet, more);
  return state == influence_.law().state_for(facet, less) ? std::optional(state) : std::nullopt;
}

std::optional<GrownContact::States> GrownContact::next_states(const Step& step) const {
  States states;
  for (std::size_t i = 0; i < step.motions.size(); ++i) {
    const bool is_own = i == influence_.facets().size();
    const FacetState facet = is_own ? own_facet({}) : influence_.facets()[i];
    const auto state =
        certain_state(facet, scaled(influence_.law().ground().stiffness, step.motions[i]));
    if (!state) {
      return std::nullopt;
    }
    states.push_back(*state);
  }
  return states;
}

/// Whether a facet in the state of `facet` slips.
void GrownContact::look_at(const FacetState& facet, std::optional<double> friction,
                           const Vec& trial, Footing& footing) const {
  if (!friction || facet.is_bonded || !facet.state.pressed) {
    return;
  }
  const Vec force = base::multiply(
      mechanics::corrector(influence_.law().ground(), facet.state, facet.is_held), trial);
  const double sideways = std::hypot(force[0], force[1]);
  const double allowed = std::abs(force[2]) * *friction;
  const double doubt = kForceShare * allowed + kStateRounding * scale_n_;
  footing.is_slipping = footing.is_slipping || sideways > allowed + doubt;
  footing.is_certain = footing.is_certain && std::abs(sideways - allowed) > doubt;
}

/// Whether the grown robot is on a flat floor: there open and tilted facets only pull down.
bool GrownContact::is_on_flat_floor(const Site& site) const {
  const auto level = [&] {
    return robot_.modules()[base::at(robot_.facets().front().module)].cell.z;
  };
  return is_flat_ && (!site.is_on_floor || robot_.facets().empty() || level() == site.cell.z);
}

/// Whether the check would end here as well, but for further solutions: it looks for the exact
/// law's answer where open and tilted facets may pull, and at the corners where no facet presses
/// all over.
Footing GrownContact::footing_of(const Site& site, const States& states, const Step& step) const {
  Footing footing;
  const bool is_flat = is_on_flat_floor(site);
  bool is_any_stuck = false;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const bool is_own = i == influence_.facets().size();
    FacetState facet = is_own ? own_facet({}) : influence_.facets()[i];
    facet.state = states[i];
    const Vec trial = scaled(influence_.law().ground().stiffness, step.motions[i]);
    const bool is_stuck = states[i] == mechanics::kStuck;
    const bool may_pull = !is_flat && !is_stuck;
    footing.is_certain = footing.is_certain && !may_pull;
    is_any_stuck = is_any_stuck || is_stuck;
    look_at(facet, is_own ? floor_.friction : robot_.facets()[i].touch.friction, trial, footing);
  }
  const bool is_standing = is_held_ || (is_any_stuck && robot_.foot_half_width_mm() > 0);
  footing.is_certain = footing.is_certain && is_standing;
  return footing;
}

/// If a facet that may have a second state comes back at once when it is put there, it has not.
bool GrownContact::may_have_others(const Site& site, const States& states, const Step& step,
                                   const FacetInfluence& facets) const {
  for (std::size_t i = 0; i < states.size(); ++i) {
    const bool is_own = i == influence_.facets().size();
    const FacetState facet = is_own ? own_facet({}) : influence_.facets()[i];
    const Vec& stiffness = influence_.law().ground().stiffness;
    const Vec trial = scaled(stiffness, step.motions[i]);
    if (facet.is_bonded || !solver::may_have_second_state(states[i], trial, kForceShare)) {
      continue;
    }
    States other = states;
    other[i] = {.pressed = !states[i].pressed};
    const NewNode& own = node(site, site.is_on_floor ? other.back() : mechanics::kStuck);
    const auto next = solve(site, own, &facets, other);
    const auto state =
        next ? certain_state(facet, scaled(stiffness, next->motions[i])) : std::nullopt;
    if (!state || state->pressed == other[i].pressed) {
      return true;
    }
  }
  return false;
}

Grown GrownContact::grown(const Site& site, const NewNode& node, Step step,
                          const Footing& footing) const {
  Grown grown{.facet_forces = std::move(step.facet_forces), .node = &node, .footing = footing};
  for (std::size_t h = 0; h < site.links.size(); ++h) {
    grown.host_loads.push_back({.module = site.links[h].host, .load = step.host_loads[h]});
  }
  return grown;
}

std::optional<Grown> GrownContact::stuck(const Site& site) const {
  const NewNode& own = node(site, {});
  auto step = solve(site, own, nullptr, {});
  if (!step) {
    return std::nullopt;
  }
  return grown(site, own, *std::move(step), {});
}

/// Whether a facet is so far from tilting and lifting that certain_state() says that it is stuck.
bool GrownContact::sticks_by_far(const Vec& trial) const {
  constexpr double kRoom = 1e-3;  // Far more than certain_state()'s doubts.
  const auto& ground = influence_.law().ground();
  const double pressure = -trial[2];
  const double sideways = std::abs(trial[0]) + std::abs(trial[1]);
  const double torque = std::max(std::abs(trial[3]), std::abs(trial[4]));
  return pressure > kRoom * kRoom * scale_n_ && pressure > kRoom * sideways &&
         pressure * ground.lever > kRoom * std::abs(trial[5]) &&
         pressure * ground.lever > kRoom * torque &&
         (1 - kRoom) * pressure * ground.half_width > torque;
}

void GrownContact::look_if_stuck(const FacetState& facet, std::optional<double> friction,
                                 const Vec& trial, Footing& footing) const {
  footing.is_certain = footing.is_certain &&
                       (sticks_by_far(trial) || certain_state(facet, trial) == mechanics::kStuck);
  look_at(facet, friction, trial, footing);
}

void GrownContact::look_at_own(const Site& site, const Vec& new_module, Footing& footing) const {
  if (!is_bonded_ && site.is_on_floor) {
    const FacetState facet = own_facet({});
    look_if_stuck(facet, floor_.friction, influence_.law().trial_force(facet, new_module), footing);
  }
}

std::optional<Grown> GrownContact::settle(const Site& site, const FacetInfluence& facets) const {
  const std::size_t count = influence_.facets().size() + (site.is_on_floor ? 1 : 0);
  const NewNode* own = nullptr;
  std::optional<Step> step;
  const auto states = settled_states(States(count), kStepCountMax, [&](const States& tried) {
    own = &node(site, site.is_on_floor ? tried.back() : mechanics::kStuck);
    step = solve(site, *own, &facets, tried);
    return step ? next_states(*step) : std::nullopt;
  });
  if (!states) {
    return std::nullopt;
  }
  Footing footing = footing_of(site, *states, *step);
  footing.is_certain = footing.is_certain && !may_have_others(site, *states, *step, facets);
  Grown result = grown(site, *own, *std::move(step), footing);
  result.is_settled = true;
  return result;
}

}  // namespace holdfast::plan
