// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/energy_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "block_product.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/model/facet_starts.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::Vec6;
using mechanics::ContactState;

/// New modules above a section are brought into balance so many times there and back.
constexpr int kSweepCount = 2;

/// A load that costs more than this share of what the load ratio leaves room for, if it goes down
/// through a single file of modules, is spread: that takes up to a millisecond.
constexpr double kSpreadShare = 0.1;

/// Where a facet's force may be off by this share of what it lacks to tilting, by its adjoint, that
/// is soon too coarse and better found anew. With 0.3 or 0.8 growth takes as long or longer.
constexpr double kStrainMax = 0.5;

bool is_plain(const model::Robot& target) {
  return std::ranges::none_of(
      target.facets(), [](const model::Facet& facet) { return facet.touch.friction.has_value(); });
}

}  // namespace

EnergyBound::EnergyBound(const model::Robot& target, const LocalAdjoints& nearby,
                         const Adjoints& adjoints, Use use)
    : target_(target),
      adjoints_(nearby),
      use_(use),
      local_(target),
      beam_(model::beam_section(target.material()), target.lattice()),
      changes_(target),
      spread_(target),
      ratio_per_norm_(model::load_ratio_per_energy_norm(target)),
      first_facet_(model::facet_starts(target)),
      nodes_(target.modules().size()),
      u_(target.modules().size()),
      room_(target.facets().size()),
      nearby_(target.facets().size()),
      watched_(target, adjoints) {
  const Vec& h = changes_.stiffness();
  const double b = target.foot_half_width_mm();
  facet_per_norm_x_ = std::sqrt(h[3] + h[2] * b * b);
  facet_per_norm_y_ = std::sqrt(h[4] + h[2] * b * b);
}

/// Whether the module has a support of its own.
bool EnergyBound::has_root(std::size_t module) const {
  return first_facet_[module] < first_facet_[module + 1] ||
         target_.modules()[module].support == model::Support::kFixed;
}

/// Whether loads are handed no further: a support carries them, or the section's modules do.
bool EnergyBound::ends_way(std::size_t module) const {
  return section_ != nullptr ? section_place_[module] >= 0 : has_root(module);
}

/// Adds what the sideways pull of a module takes on its way to a support.
void EnergyBound::add_sway(std::size_t module) {
  const Vec& h = changes_.stiffness();
  const double pitch = target_.material().pitch_mm;
  const double n = nodes_[module].depth + 1.0;
  const double arms = pitch * pitch * n * (4 * n * n - 1) / 12;
  const double more =
      target_.mass(module) * std::sqrt(n / *std::min_element(h.begin(), h.begin() + 3) +
                                       arms / *std::min_element(h.begin() + 3, h.end()));
  double& sum = sway_[nodes_[module].root];
  sway_square_ += more * (2 * sum + more);
  sum += more;
}

/// How far a way down through this neighbour leads aside within two steps, squared, in mm^2.
double EnergyBound::distance_aside(std::size_t module, std::size_t neighbour) const {
  const Node& next = nodes_[neighbour];
  const Vec& below = changes_.place(next.way.to < 0 ? neighbour : base::at(next.way.to));
  const double x = below[0] - changes_.place(module)[0];
  const double y = below[1] - changes_.place(module)[1];
  return x * x + y * y;
}

/// The way down: to one of the neighbours that are nearest to a support, that through which
/// it leads down most nearly straight, as a weight that is carried aside costs much.
void EnergyBound::choose_way(std::size_t module) {
  Node& node = nodes_[module];
  const int straight = base::index(base::down(target_.lattice()));
  std::int32_t depth_min = std::numeric_limits<std::int32_t>::max();
  double aside_min = 0;
  for (const base::Direction direction : base::directions(target_.lattice())) {
    const int d = base::index(direction);
    const std::int32_t other = target_.connected()[module][base::at(d)];
    if (other == model::Robot::kNoNeighbour || !nodes_[base::at(other)].is_there ||
        nodes_[base::at(other)].depth > depth_min) {
      continue;
    }
    const double aside = distance_aside(module, base::at(other));
    if (nodes_[base::at(other)].depth < depth_min || aside < aside_min ||
        (aside == aside_min && d == straight)) {
      depth_min = nodes_[base::at(other)].depth;
      aside_min = aside;
      node.way = {.to = other, .direction = d};
    }
  }
  node.depth = has_root(module) ? 0 : depth_min + 1;
  node.root = has_root(module) ? module : nodes_[base::at(node.way.to)].root;
}

/// Moves a module until it is in balance, all others staying where they are.
void EnergyBound::take_place(std::size_t module) {
  local_.insert(module);
  u_[module] = block_product(local_.stiffness(module).inverse, local_.pull(module, u_));
}

/// Adds what the gaps of its beams mean as long as no load goes through these.
void EnergyBound::open_gaps(std::size_t module) {
  const Node& node = nodes_[module];
  local_.for_each_neighbour(module, [&](base::Direction direction, std::size_t other) {
    if (!nodes_[other].is_new || nodes_[other].place <= node.place) {
      nodes_[other].is_host = true;
      changes_.open_gap(module, base::index(direction), u_[module], u_[other]);
    }
  });
}

/// The moved mass of all modules that are there, by where they are now.
verdict::MovedMass EnergyBound::moved_mass() const {
  verdict::MovedMass moved;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].is_there) {
      moved.add(target_.mass(i), u_[i][0], u_[i][1]);
    }
  }
  return moved;
}

EnergyBound::Vec EnergyBound::trial_force(const model::Facet& facet, const Vec& u) const {
  return mechanics::trial_force(solver::facet_law(target_, beam_, {.gamma = 0}).ground(),
                                beam_.to_local(facet.direction, u));
}

/// What |s - h w| / 2 may be before the facet tilts.
void EnergyBound::look_at_facet(std::size_t index) {
  const model::Facet& facet = target_.facets()[index];
  const std::size_t module = base::at(facet.module);
  const bool is_new = nodes_[module].is_new;
  if (!is_new) {
    before_.looked_at.push_back(index);
  }
  const Vec moved = trial_force(facet, u_[module]);
  changes_.weigh_facet(index, is_new ? moved : Vec{});
  Vec change = changes_.facet_change(index);
  for (std::size_t i = 0; is_new && i < 6; ++i) {
    change[i] -= moved[i];
  }
  room_[index] = room_with(index, u_[module], change);
}

double EnergyBound::room_with(std::size_t index, const Vec& u, const Vec& change) const {
  const model::Facet& facet = target_.facets()[index];
  if (facet.is_bonded()) {
    return std::numeric_limits<double>::infinity();
  }
  const Vec moved = trial_force(facet, u);
  const double limit = -(moved[2] + change[2] / 2) * target_.foot_half_width_mm();
  return std::min((limit - std::abs(moved[3] + change[3] / 2)) / facet_per_norm_x_,
                  (limit - std::abs(moved[4] + change[4] / 2)) / facet_per_norm_y_);
}

bool EnergyBound::are_pressed_with(std::span<const std::size_t> hosts, double radius,
                                   const std::function<double(std::size_t)>& room,
                                   const std::function<Changes(std::size_t)>& changes) {
  const auto mark = [&](bool is_host) {
    std::ranges::for_each(hosts, [&](std::size_t host) { nodes_[host].is_host = is_host; });
  };
  const double reach = radius + solved_error_ / 2;
  mark(true);
  const bool are_all = std::ranges::all_of(facets_, [&](std::size_t facet) {
    return reach < room(facet) || is_pressed_nearby(facet, reach, changes(facet));
  });
  mark(false);
  return are_all;
}

/// What a module's load costs if it goes straight down, through a single file of modules.
double EnergyBound::way_energy(std::size_t from) const {
  const Vec load = load_about_origin(target_, from, changes_.place(from));
  double energy = 0;
  for (std::size_t module = from; !ends_way(module);) {
    const Way& way = nodes_[module].way;
    energy += changes_.energy_of(changes_.middle(load, module, way.direction));
    module = base::at(way.to);
  }
  return energy;
}

/// Whether a module's load, on a single file of modules, takes much of what there is room for.
bool EnergyBound::is_far_aside(std::size_t module) const {
  const double norm_max = 2 * (kRatioMax - solved_ratio_) / ratio_per_norm_;
  return way_energy(module) > kSpreadShare * norm_max * norm_max;
}

std::vector<LoadSpread::Load> EnergyBound::loads_beside(std::size_t module) const {
  std::vector<LoadSpread::Load> loads;
  local_.for_each_neighbour(module, [&](base::Direction direction, std::size_t other) {
    if (target_.modules()[other].support != model::Support::kFixed) {
      LoadSpread::Load& load = loads.emplace_back(LoadSpread::Load{.module = other});
      base::add_times(load.force, -1,
                      beam_.end_force(base::opposite(direction), u_[other], u_[module]));
    }
  });
  return loads;
}

/// A module's beams carry what they do where it is now, and what they put on its neighbours goes on
/// to supports through all modules near its way, but for itself where it is to be taken back. False
/// if that cannot be.
bool EnergyBound::spread(std::size_t from) {
  std::vector<std::size_t> way = {from};
  while (!ends_way(way.back())) {
    way.push_back(base::at(nodes_[way.back()].way.to));
  }
  const std::vector<LoadSpread::Load> loads = loads_beside(from);
  std::span<const std::size_t> below = way;
  if (use_ == Use::kTrying) {
    below = below.subspan(1);
    local_.erase(from);
  }
  const std::vector<LoadSpread::Share> shares = spread_.spread(below, loads, local_);
  local_.insert(from);
  if (shares.empty()) {
    return false;
  }
  local_.for_each_neighbour(from, [&](base::Direction direction, std::size_t other) {
    changes_.bear(from, base::index(direction), u_[from], u_[other]);
  });
  std::ranges::for_each(shares, [&](const LoadSpread::Share& share) { bear(share); });
  return true;
}

void EnergyBound::bear(const LoadSpread::Share& share) {
  const std::vector<std::size_t>& modules = share.part->modules;
  for (const SpreadPart::Beam& beam : share.part->beams) {
    changes_.bear(modules[base::at(beam.a)], base::index(beam.direction), share.u[base::at(beam.a)],
                  beam.b < 0 ? Vec{} : share.u[base::at(beam.b)]);
  }
  for (std::size_t i = 0; i < modules.size(); ++i) {
    for (std::size_t facet = first_facet_[modules[i]]; facet < first_facet_[modules[i] + 1];
         ++facet) {
      changes_.bear(facet, trial_force(target_.facets()[facet], share.u[i]));
      look_at_facet(facet);
    }
  }
}

/// Hands a module's load on to a support.
void EnergyBound::carry(std::size_t from) {
  const Vec load = load_about_origin(target_, from, changes_.place(from));
  std::size_t module = from;
  for (; !ends_way(module); module = base::at(nodes_[module].way.to)) {
    changes_.hand_on(module, nodes_[module].way.direction, load);
  }
  if (section_ != nullptr) {
    base::add_to(borne_[base::at(section_place_[module])], load);
    return;
  }
  const std::size_t facet = first_facet_[module];
  if (facet < first_facet_[module + 1]) {
    changes_.bear(facet,
                  changes_.middle(load, module, base::index(target_.facets()[facet].direction)));
    look_at_facet(facet);
  }
}

/// Forgets what is known of facets in whose patch, or beside it, modules have come or gone since
/// the robot was solved last.
void EnergyBound::forget_nearby(const std::vector<Element>& elements) {
  std::vector<bool> is_there(nodes_.size());
  for (const Element element : elements) {
    is_there[base::at(element)] = true;
  }
  std::vector<bool> is_changed(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (is_there[i] == (nodes_[i].is_there && !nodes_[i].is_new)) {
      continue;
    }
    is_changed[i] = true;
    for (const std::int32_t other : target_.connected()[i]) {
      if (other != model::Robot::kNoNeighbour) {
        is_changed[base::at(other)] = true;
      }
    }
  }
  for (std::optional<LocalAdjoint>& nearby : nearby_) {
    if (nearby &&
        std::ranges::any_of(nearby->patch, [&](std::size_t i) { return is_changed[i]; })) {
      nearby.reset();
    }
  }
}

bool EnergyBound::begin(const std::vector<Element>& elements, const verdict::Assessment& solved,
                        const SectionResponse* section) {
  const bool is_stuck = solver::are_all_stuck(solved.equilibrium);
  const bool is_known = solved.verdict == verdict::Verdict::kSafe ||
                        (use_ == Use::kTrying && solved.verdict == verdict::Verdict::kOverload);
  if (!is_known || !is_stuck || solved.several ||
      solved.stability_rule == verdict::StabilityRule::kContactForces ||
      solved.contact_model == verdict::ContactModel::kUnilateral || !is_plain(target_)) {
    has_core_ = false;
    return false;
  }
  has_core_ = true;
  section_ = section;
  choose_ways(elements);
  solved_error_ = verdict::kEnergyFactor * solved.equilibrium.energy_error;
  solved_ratio_ = solved.load_ratio_max ? std::max(0.0, solved.load_ratio_range.high) : 0.0;
  solved_ratio_low_ = solved.load_ratio_max ? solved.load_ratio_range.low : 0.0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    u_[base::at(elements[i])] = solved.equilibrium.displacement[i];
  }
  sway_.assign(nodes_.size(), 0);
  sway_square_ = 0;
  for (const Element element : elements) {
    add_sway(base::at(element));
  }
  still_moved_ = moved_ = moved_mass();
  if (section_ != nullptr) {
    still_ = u_;
    own_error_ = solved_error_;
    borne_.assign(section_->modules().size(), {});
  }
  std::ranges::for_each(facets_, [&](std::size_t facet) { look_at_facet(facet); });
  watched_.begin(elements, u_);
  return true;
}

/// Begins with nothing but these modules, from supports upwards.
void EnergyBound::choose_ways(const std::vector<Element>& elements) {
  forget_nearby(elements);
  std::ranges::fill(nodes_, Node{});
  facets_.clear();
  forget_changes();
  local_.assign(elements);
  section_place_.assign(section_ == nullptr ? 0 : nodes_.size(), -1);
  for (std::size_t i = 0; section_ != nullptr && i < section_->modules().size(); ++i) {
    section_place_[section_->modules()[i]] = static_cast<std::int32_t>(i);
  }
  std::vector<std::size_t> queue;
  for (const Element element : elements) {
    Node& node = nodes_[base::at(element)];
    node.is_there = true;
    node.depth = std::numeric_limits<std::int32_t>::max() - 1;
    if (has_root(base::at(element))) {
      node.depth = 0;
      queue.push_back(base::at(element));
    }
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const std::int32_t depth = nodes_[queue[i]].depth + 1;
    for (const std::int32_t other : target_.connected()[queue[i]]) {
      if (other != model::Robot::kNoNeighbour && nodes_[base::at(other)].is_there &&
          nodes_[base::at(other)].depth > depth) {
        nodes_[base::at(other)].depth = depth;
        queue.push_back(base::at(other));
      }
    }
  }
  for (const std::size_t module : queue) {
    if (has_root(module)) {
      nodes_[module].root = module;
    } else {
      choose_way(module);
    }
  }
  choose_section_ways();
  for (const Element element : elements) {
    const std::size_t module = base::at(element);
    for (std::size_t facet = first_facet_[module]; facet < first_facet_[module + 1]; ++facet) {
      facets_.push_back(facet);
    }
  }
}

/// The ways between modules of the section: from each to an earlier one, from the first to none.
void EnergyBound::choose_section_ways() {
  for (std::size_t i = 0; section_ != nullptr && i < section_->modules().size(); ++i) {
    const std::size_t module = section_->modules()[i];
    nodes_[module].way = {};
    local_.for_each_neighbour(module, [&](base::Direction direction, std::size_t other) {
      if (section_place_[other] >= 0 && base::at(section_place_[other]) < i) {
        nodes_[module].way = {.to = static_cast<std::int32_t>(other),
                              .direction = base::index(direction)};
      }
    });
  }
}

/// What has been attached since the robot was solved is part of it now.
void EnergyBound::settle_new() {
  std::vector<Element> elements;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].is_there) {
      elements.push_back(static_cast<Element>(i));
    }
  }
  forget_nearby(elements);
  for (Node& node : nodes_) {
    node.is_new = node.is_host = false;
  }
  forget_changes();
}

void EnergyBound::forget_changes() {
  new_.clear();
  changes_.clear();
  section_ratio_ = 0;
}

/// Whether a facet that was there when the robot was solved stays stuck, as far as the
/// modules near it show, if |s - h w| / 2 is no more than `radius`.
bool EnergyBound::is_pressed_nearby(std::size_t index, double radius, const Changes& changes) {
  const model::Facet& facet = target_.facets()[index];
  const Node& node = nodes_[base::at(facet.module)];
  if (node.is_new) {
    return false;
  }
  std::optional<LocalAdjoint>& nearby = nearby_[index];
  if (!nearby) {
    nearby = adjoints_.find(facet, [&](std::size_t module) {
      return nodes_[module].is_there && !nodes_[module].is_new;
    });
  }
  if (!nearby->gram ||
      std::ranges::any_of(nearby->patch, [&](std::size_t i) { return nodes_[i].is_host; })) {
    return false;
  }
  const Vec force = trial_force(facet, u_[base::at(facet.module)]);
  const double b = target_.foot_half_width_mm();
  const auto holds = [&](double torque, double mx, double my, double lack_per_norm) {
    const double slack = -(force[2] + changes.high[2]) * b - torque - lack_per_norm * solved_error_;
    return std::ranges::all_of(std::array{1.0, -1.0}, [&](double sign) {
      return 2 * radius * nearby->gram->norm({b, sign * mx, sign * my}) < slack;
    });
  };
  const auto torque = [&](std::size_t i) {
    return std::max(std::abs(force[i] + changes.high[i]), std::abs(force[i] + changes.low[i]));
  };
  return holds(torque(3), 1, 0, facet_per_norm_x_) && holds(torque(4), 0, 1, facet_per_norm_y_);
}

/// Counts all that are doubtful, as one that is known better makes room for the next only.
bool EnergyBound::are_pressed(double radius) {
  bool are_all = true;
  for (const std::size_t facet : facets_) {
    if (radius < room_[facet] || is_pressed_nearby(facet, radius, {})) {
      continue;
    }
    const double strain = strain_by_adjoint(facet);
    if (!(strain < 1)) {
      are_all = false;
    }
    if (!(strain < kStrainMax)) {
      ++doubtful_[facet];
    }
  }
  return are_all;
}

/// What a facet may be off by as a share of what it lacks to tilting, by its adjoint, if the
/// displacements are off by the energy error at most: it stays stuck below 1.
double EnergyBound::strain_by_adjoint(std::size_t index) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const model::Facet& facet = target_.facets()[index];
  if (section_ != nullptr || nodes_[base::at(facet.module)].is_new) {
    return kUnknown;
  }
  const double b = target_.foot_half_width_mm();
  const auto known = watched_.find(index, u_);
  double largest = known ? 0 : kUnknown;
  const auto look = [&](double torque, double x, double y) {
    const double slack = -known->force[0] * b - std::abs(torque);
    for (const double sign : {1.0, -1.0}) {
      const double error = known->error({b, sign * x, sign * y}, energy_error());
      largest = std::max(largest, error < slack ? error / slack : kUnknown);
    }
  };
  if (known) {
    look(known->force[1], 1, 0);
    look(known->force[2], 0, 1);
  }
  return largest;
}

/// A module is there, in balance with its neighbours where there is no section.
void EnergyBound::place(std::size_t module) {
  choose_way(module);
  Node& node = nodes_[module];
  node.is_there = true;
  node.is_new = true;
  node.place = new_.size();
  before_.sway = sway_[node.root];
  before_.sway_square = sway_square_;
  before_.looked_at.clear();
  add_sway(module);
  if (section_ != nullptr) {
    return;
  }
  take_place(module);
  moved_.add(target_.mass(module), u_[module][0], u_[module][1]);
  new_.push_back(module);
  for (std::size_t facet = first_facet_[module]; facet < first_facet_[module + 1]; ++facet) {
    facets_.push_back(facet);
  }
  watched_.attach(module);
}

base::Vec6<double> EnergyBound::follow(std::size_t module,
                                       const std::function<Vec(std::size_t)>& displacement) {
  std::vector<LocalBalance::Beam> beams;
  local_.add_beams(module, beams);
  Vec rest{};
  for (const LocalBalance::Beam& beam : beams) {
    base::add_times(rest, -1, block_product(*beam.block_12, displacement(beam.other)));
  }
  return block_product(local_.stiffness(module).inverse, rest);
}

std::optional<double> EnergyBound::add(Element element) {
  const std::size_t module = base::at(element);
  if (!has_core_ || target_.modules()[module].support == model::Support::kFixed) {
    return std::nullopt;
  }
  place(module);
  if (section_ != nullptr) {
    return add_above_section(module);
  }
  open_gaps(module);
  for (std::size_t facet = first_facet_[module] + 1; facet < first_facet_[module + 1]; ++facet) {
    look_at_facet(facet);
  }
  if (!is_far_aside(module) || !spread(module)) {
    carry(module);
  }
  return bound();
}

void EnergyBound::take_back() {
  const std::size_t module = new_.back();
  local_.erase(module);
  changes_.clear();
  sway_[nodes_[module].root] = before_.sway;
  sway_square_ = before_.sway_square;
  moved_ = still_moved_;
  for (std::size_t facet = first_facet_[module]; facet < first_facet_[module + 1]; ++facet) {
    facets_.pop_back();
  }
  local_.for_each_neighbour(module, [&](base::Direction /*direction*/, std::size_t other) {
    nodes_[other].is_host = false;
  });
  nodes_[module] = {};
  new_.pop_back();
  watched_.detach_last();
  const std::vector<std::size_t> looked_at = std::exchange(before_.looked_at, {});
  std::ranges::for_each(looked_at, [&](std::size_t facet) { look_at_facet(facet); });
}

/// The solved load ratio is no more than that of (s + h w) / 2 and that of what it has changed by,
/// turned round, as c(a + b) <= c(a) + c(b).
std::optional<double> EnergyBound::ratio_low() {
  const double radius = energy_error() / 2;
  if (!are_pressed(radius + solved_error_ / 2)) {
    return std::nullopt;
  }
  return solved_ratio_low_ - changes_.load_ratio_turned() - ratio_per_norm_ * radius;
}

std::optional<double> EnergyBound::add_above_section(std::size_t module) {
  const std::size_t section_depth = base::at(nodes_[section_->modules().front()].depth);
  if (has_root(module) || base::at(nodes_[module].depth) <= section_depth) {
    return std::nullopt;
  }
  new_.push_back(module);
  local_.insert(module);
  carry(module);
  Vec sum{};
  for (const Vec& borne : borne_) {
    base::add_to(sum, borne);
  }
  resultant_ = section_->resultant(sum);
  solved_error_ = own_error_ + section_->error(resultant_);
  move_with_section();
  bear_by_section();
  return bound();
}

/// The core moves by its answer to the resultant, and new modules into balance on it, one after
/// another, there and back.
void EnergyBound::move_with_section() {
  const auto move = [&](std::size_t module) {
    u_[module] = still_[module];
    base::add_to(u_[module], section_->displacement(module, resultant_));
  };
  for (const std::size_t facet : facets_) {
    move(base::at(target_.facets()[facet].module));
    look_at_facet(facet);
  }
  for (const std::size_t module : new_) {
    local_.for_each_neighbour(module, [&](base::Direction /*direction*/, std::size_t other) {
      if (!nodes_[other].is_new) {
        move(other);
      }
    });
  }
  std::ranges::for_each(new_, [&](std::size_t module) { local_.erase(module); });
  std::ranges::for_each(new_, [&](std::size_t module) { take_place(module); });
  for (int sweep = 0; sweep < kSweepCount; ++sweep) {
    for (std::size_t i = new_.size(); i-- > 0;) {
      take_place(new_[i]);
    }
    std::ranges::for_each(new_, [&](std::size_t module) { take_place(module); });
  }
  const verdict::MovedMass by_section = section_->moved_mass(resultant_);
  moved_ = still_moved_;
  moved_.x_kg_mm += by_section.x_kg_mm;
  moved_.y_kg_mm += by_section.y_kg_mm;
  for (const std::size_t module : new_) {
    moved_.add(target_.mass(module), u_[module][0], u_[module][1]);
  }
}

/// The section's modules carry what the answer takes them to; what they get is carried to there,
/// and what all ways carry is weighed against how new modules lie now.
void EnergyBound::bear_by_section() {
  std::ranges::for_each(new_, [&](std::size_t module) { open_gaps(module); });
  std::vector<Vec> rest = borne_;
  for (std::size_t i = rest.size(); i-- > 0;) {
    const std::size_t module = section_->modules()[i];
    Node& node = nodes_[module];
    node.is_host = true;
    if (node.way.to < 0) {
      continue;  // The first, where nothing remains.
    }
    base::add_times(rest[i], -1, section_->share(i, resultant_));
    const Way& way = node.way;
    changes_.hand_on_only(module, way.direction, rest[i]);
    base::add_to(rest[base::at(section_place_[base::at(way.to)])], rest[i]);
  }
  changes_.weigh_all();
  section_ratio_ = section_->load_ratio(resultant_);  // A beam may carry both.
}

/// A bound of the largest load ratio, if every facet is stuck.
std::optional<double> EnergyBound::bound() {
  const double radius = energy_error() / 2;
  const double ratio =
      solved_ratio_ + changes_.load_ratio() + section_ratio_ + ratio_per_norm_ * radius;
  if (!(ratio < kRatioMax) || !are_pressed(radius + solved_error_ / 2)) {
    return std::nullopt;
  }
  return ratio;
}

std::optional<double> EnergyBound::improve(const std::vector<Vec>& displacement,
                                           const FollowedRobot::Result& known) {
  settle_new();
  watched_.improve(known.moved);
  u_ = displacement;
  moved_ = moved_mass();
  solved_error_ = known.energy_error;
  solved_ratio_ = known.load_ratio;
  std::ranges::for_each(facets_, [&](std::size_t facet) { look_at_facet(facet); });
  return bound();
}

}  // namespace holdfast::plan
