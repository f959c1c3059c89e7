// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "judges/loss_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bounds/loop_bound.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/plan/candidates.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;
using solver::kLaneCount;
using solver::LaneBlock;
using verdict::Verdict;

/// Above so many blocks that fill in per module a solution for a loss takes as long as a check.
constexpr std::size_t kLossFillMax = 400;

/// Bounds nearer to 1 are not trusted, as of EnergyBound.
constexpr double kLossRatioMax = 1 - 1e-3;

/// What rounding may add to an energy, as a share of the terms that it is a sum of.
constexpr double kEnergyRounding = 1e-9;

/// Rounding in how far bending moves the centre of mass, as a share.
constexpr double kLossSwayRounding = 1e-6;

/// The modules that the forces of what is lost act on.
std::vector<std::size_t> places_of(const LostPart& part, const model::Robot& robot) {
  std::vector<std::size_t> places;
  for (const model::Connection& beam : part.change.lost_beams) {
    places.push_back(at(beam.a));
    places.push_back(at(beam.b));
  }
  for (const std::size_t facet : part.change.lost_facets) {
    places.push_back(at(robot.facets()[facet].module));
  }
  if (part.module) {
    places.push_back(*part.module);
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace

std::unique_ptr<LossJudge> LossJudge::make(const model::RobotSpec& spec, const model::Robot& robot,
                                           const verdict::Assessment& solved,
                                           std::span<const LostPart> parts,
                                           const solver::EquilibriumOptions& options) {
  std::unique_ptr<LossJudge> judge(new LossJudge(spec, robot, solved, options));
  return judge->prepare(parts) ? std::move(judge) : nullptr;
}

LossJudge::LossJudge(const model::RobotSpec& spec, const model::Robot& robot,
                     const verdict::Assessment& solved, const solver::EquilibriumOptions& options)
    : spec_(spec),
      robot_(robot),
      solved_(solved),
      options_(options),
      ratio_per_norm_(model::load_ratio_per_energy_norm(robot)) {
  if (solved.load_ratio_max) {
    solved_ratio_ = std::max(0.0, solved.load_ratio_range.high);
  }
  options_.method = solver::Method::kDirect;
  options_.fill_max = kLossFillMax;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const Vec& load = robot.loads()[i];
    scale_n_ += std::hypot(load[0], load[1], load[2]);
  }
}

bool LossJudge::prepare(std::span<const LostPart> parts) {
  if (!is_stuck_and_safe(solved_, options_.is_bonded)) {
    return false;
  }
  influence_ = solver::Influence::make(robot_, options_);
  if (!influence_ || !(rounding_share(robot_, *influence_) <= kRoundingShareMax)) {
    return false;
  }
  core_.emplace(*influence_);
  contact_.emplace(robot_, spec_.floor, *core_, options_.is_bonded);
  if (!is_stuck()) {
    return false;
  }
  if (has_polygon() && robot_.carried().empty()) {
    shrinking_.emplace(robot_);
  }
  find_inverse(parts);
  if (has_polygon()) {
    sway_.emplace(robot_, *influence_);
  }
  look_at_facets();
  return true;
}

bool LossJudge::is_stuck() const {
  const auto& displacement = influence_->displacement();
  return options_.is_bonded ||
         std::ranges::all_of(influence_->facets(), [&](const solver::FacetState& facet) {
           return influence_->law().state_at(facet, displacement[facet.module]) ==
                  mechanics::kStuck;
         });
}

/// K^-1 between all modules that the forces of one loss act on.
void LossJudge::find_inverse(std::span<const LostPart> parts) {
  std::vector<std::size_t> modules;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const LostPart& part : parts) {
    if (!knows(part)) {
      continue;
    }
    const std::vector<std::size_t> places = places_of(part, robot_);
    for (std::size_t i = 0; i < places.size(); ++i) {
      modules.push_back(places[i]);
      for (std::size_t j = 0; j < i; ++j) {
        pairs.emplace_back(places[j], places[i]);
      }
    }
  }
  std::ranges::sort(modules);
  modules.erase(std::unique(modules.begin(), modules.end()), modules.end());
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<solver::Edge> edges;
  edges.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    edges.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
  }
  influence_->find_inverse(modules, edges, options_.thread_count);
}

/// What facets leave room for.
void LossJudge::look_at_facets() {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  room_ = next_room_ = kAll;
  const Vec h = middle_stiffness(influence_->beam());
  const double b = robot_.foot_half_width_mm();
  const double per_norm_x = std::sqrt(h[3] + h[2] * b * b);
  const double per_norm_y = std::sqrt(h[4] + h[2] * b * b);
  for (std::size_t i = 0; i < robot_.facets().size() && !options_.is_bonded; ++i) {
    if (robot_.facets()[i].is_bonded()) {
      continue;
    }
    double room = -1;
    if (!robot_.facets()[i].touch.friction) {
      const solver::FacetState& facet = influence_->facets()[i];
      const Vec force =
          influence_->law().trial_force(facet, influence_->displacement()[facet.module]);
      room = std::min((-force[2] * b - std::abs(force[3])) / per_norm_x,
                      (-force[2] * b - std::abs(force[4])) / per_norm_y);
    }
    if (room < room_) {
      next_room_ = std::exchange(room_, room);
      tightest_ = i;
    } else {
      next_room_ = std::min(next_room_, room);
    }
  }
}

bool LossJudge::knows(const LostPart& part) const {
  if (part.is_apart || part.has_fixed || part.fallen_count > 0 || !part.body.empty()) {
    return false;
  }
  return options_.is_bonded || !has_polygon() || margin_mm(part).value_or(-1) > 0;
}

/// What is left of the margin, at least.
std::optional<double> LossJudge::margin_mm(const LostPart& part) const {
  if (!part.module && part.change.lost_facets.empty()) {
    return solved_.simplified.margin_mm;
  }
  return shrinking_ ? shrinking_->margin_mm_without(part.module, part.change.lost_facets)
                    : std::nullopt;
}

Vec6<double> LossJudge::displacement(std::size_t module, const Changed& changed) const {
  Vec u = core_->displacement(module);
  for (const PointLoad& load : changed.loads) {
    base::add_to(u, core_->answer(module, load));
  }
  return u;
}

/// Whether bending surely leaves the centre of mass over the polygon.
bool LossJudge::stays_over_polygon(const LostPart& part, const Changed& changed) const {
  if (!sway_ || options_.is_bonded) {
    return true;
  }
  verdict::MovedMass moved = sway_->moved(changed.loads);
  if (part.module) {
    const Vec own = displacement(*part.module, changed);
    moved.add(-robot_.mass(*part.module), own[0], own[1]);
  }
  const auto margin = margin_mm(part);
  return margin && moved.shift_mm() * (1 + kLossSwayRounding) < *margin;
}

/// The energy of the change, at most.
double LossJudge::energy(const LostPart& part, const Changed& changed) const {
  double energy = 0;
  double terms = 0;
  const auto add = [&](double work) {
    energy += work;
    terms += std::abs(work);
  };
  const Vec h = middle_stiffness(influence_->beam());
  const auto moved = [&](std::size_t module) {
    return base::sum_of<double>(displacement(module, changed), -1, core_->displacement(module));
  };
  for (const model::Connection& beam : part.change.lost_beams) {
    const Vec before = influence_->beam().middle_force(
        beam.direction, core_->displacement(at(beam.a)), core_->displacement(at(beam.b)));
    const Vec more =
        influence_->beam().middle_force(beam.direction, moved(at(beam.a)), moved(at(beam.b)));
    for (std::size_t k = 0; k < 6; ++k) {
      add(before[k] * more[k] / h[k]);
    }
  }
  for (const std::size_t lost : part.change.lost_facets) {
    const solver::FacetState& facet = influence_->facets()[lost];
    const auto& law = influence_->law();
    const Vec before = law.trial_force(facet, core_->displacement(facet.module));
    const Vec more = law.trial_force(facet, moved(facet.module));
    for (std::size_t k = 0; k < 6; ++k) {
      add(before[k] * more[k] / law.ground().stiffness[k]);
    }
  }
  for (const PointLoad& load : part.change.loads) {
    add(base::dot(load.load, moved(load.module)));
  }
  return std::max(0.0, energy) + kEnergyRounding * terms;
}

std::optional<double> LossJudge::bound(const LostPart& part) const {
  if (room_ < 0 || !knows(part)) {
    return std::nullopt;
  }
  const auto changed = ChangedRobot(*core_, part.change, scale_n_).solve({});
  if (!changed) {
    return std::nullopt;
  }
  const double norm = std::sqrt(energy(part, *changed));
  const bool is_tightest_lost =
      std::ranges::find(part.change.lost_facets, tightest_) != part.change.lost_facets.end();
  const double ratio = solved_ratio_ + ratio_per_norm_ * norm;
  const bool is_certain = ratio < kLossRatioMax && norm < (is_tightest_lost ? next_room_ : room_) &&
                          stays_over_polygon(part, *changed);
  return is_certain ? std::optional(ratio) : std::nullopt;
}

void LossJudge::judge(std::span<const LostPart* const> parts,
                      std::span<std::optional<Judgement>> judged) const {
  const std::size_t group_count = (parts.size() + kLaneCount - 1) / kLaneCount;
  host::Team team(options_.thread_count, group_count * host::Team::kChunk);
  team.each(group_count, [&](std::size_t group) {
    const std::size_t first = group * kLaneCount;
    const std::size_t count = std::min(kLaneCount, parts.size() - first);
    judge_lanes(parts.subspan(first, count), judged.subspan(first, count));
  });
}

void LossJudge::judge_lanes(std::span<const LostPart* const> parts,
                            std::span<std::optional<Judgement>> judged) const {
  std::vector<LaneBlock> more(influence_->slot_count());
  std::vector<std::optional<Changed>> changed(parts.size());
  for (std::size_t lane = 0; lane < parts.size(); ++lane) {
    if (knows(*parts[lane])) {
      changed[lane] = ChangedRobot(*core_, parts[lane]->change, scale_n_).solve({});
    }
    for (std::size_t i = 0; changed[lane] && i < changed[lane]->loads.size(); ++i) {
      const PointLoad& point = changed[lane]->loads[i];
      for (std::size_t k = 0; k < 6; ++k) {
        more[influence_->slot(point.module)].values[k][lane] += point.load[k];
      }
    }
  }
  influence_->solve(more);
  for (std::size_t lane = 0; lane < parts.size(); ++lane) {
    if (changed[lane]) {
      judged[lane] = judgement(*parts[lane], *changed[lane], [&](std::size_t module) {
        Vec moved = influence_->displacement()[module];
        for (std::size_t k = 0; k < 6; ++k) {
          moved[k] += more[influence_->slot(module)].values[k][lane];
        }
        return moved;
      });
    }
  }
}

/// What displacements u(module) say; none if a check has to say it.
template <class Displacement>
std::optional<Judgement> LossJudge::judgement(const LostPart& part, const Changed& changed,
                                              const Displacement& u) const {
  const Footing footing = contact_->footing_if_stuck({}, {}, u, part.change.lost_facets);
  if (!footing.is_certain || footing.is_slipping) {
    return std::nullopt;
  }
  double ratio = -std::numeric_limits<double>::infinity();
  for (const model::Connection& pair : robot_.connections()) {
    if (!part.lacks(pair)) {
      const Vec force =
          influence_->beam().middle_force(pair.direction, u(at(pair.a)), u(at(pair.b)));
      ratio = std::max(ratio, model::load_ratio(robot_.connector(pair), force).ratio);
    }
  }
  const double doubt = kNearLimit * std::max(1.0, std::abs(ratio));
  const bool is_certain = std::isfinite(ratio) && std::abs(ratio - 1) > doubt &&
                          (ratio > 1 || stays_over_polygon(part, changed));
  return is_certain
             ? std::optional(Judgement{.verdict = ratio > 1 ? Verdict::kOverload : Verdict::kSafe,
                                       .load_ratio_max = ratio})
             : std::nullopt;
}

}  // namespace holdfast::plan
