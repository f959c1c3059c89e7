// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "judges/bounded_candidates.hpp"

#include <utility>

#include "balance.hpp"
#include "bounds/place_bounds.hpp"
#include "own_solution.hpp"

namespace holdfast::plan {

using verdict::Verdict;

std::unique_ptr<BoundedCandidates> BoundedCandidates::make(const model::RobotSpec& spec,
                                                           const CandidateOptions& options) {
  auto robot = model::Robot::create(spec, options.equilibrium.thread_count);
  if (!robot || needs_own_solution(robot.value()) || options.equilibrium.is_bonded) {
    return nullptr;
  }
  std::unique_ptr<BoundedCandidates> made(
      new BoundedCandidates(spec, options, std::move(robot).value()));
  return made->solve() ? std::move(made) : nullptr;
}

BoundedCandidates::BoundedCandidates(const model::RobotSpec& spec, const CandidateOptions& options,
                                     model::Robot robot)
    : spec_(spec), options_(options), robot_(std::move(robot)), look_(robot_, spec, options) {}

bool BoundedCandidates::solve() {
  if (!look_.can_judge()) {
    return false;
  }
  solver::EquilibriumOptions solver = options_.equilibrium;
  solver.has_rigid_figures = false;
  solved_ = assess(robot_, as_checked(robot_, solver));
  solved_.connections = {};
  const bool is_decided = look_.is_held() || look_.finder().has_polygon();
  return (solved_.verdict == Verdict::kSafe || solved_.verdict == Verdict::kOverload) && is_decided;
}

std::vector<BoundedCandidates::Place> BoundedCandidates::judge(
    std::span<const base::Cell> cells, bool follows, const std::function<bool()>& is_late) const {
  const double doubt = Balance::kMarginDoubt * robot_.material().pitch_mm;
  std::vector<Place> places(cells.size());
  std::vector<base::Cell> open;
  std::vector<std::pair<std::size_t, std::optional<double>>> waiting;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    RigidLook::Answer look = look_.at(cells[i]);
    places[i].candidate = look.decided;
    if (look.site) {
      open.push_back(cells[i]);
      waiting.emplace_back(i, look.margin_mm);
    }
  }
  const auto bounds = bound_places(
      spec_, solved_, open,
      {.thread_count = options_.equilibrium.thread_count, .follows = follows, .is_late = is_late});
  for (std::size_t k = 0; k < open.size(); ++k) {
    const auto& [i, margin_mm] = waiting[k];
    const PlaceBound& bound = bounds[k];
    places[i].ratio_low = bound.low.value_or(places[i].ratio_low);
    if (bound.is_overload()) {
      places[i].candidate = Candidate{
          .cell = open[k],
          .is_robot = true,
          .judgement = {.verdict = Verdict::kOverload, .margin_mm = margin_mm, .is_bound = true}};
    }
    const bool stays = look_.is_held() || (margin_mm && bound.shift_mm < *margin_mm - doubt);
    if (bound.high && stays) {
      places[i].candidate = Candidate{.cell = open[k],
                                      .is_robot = true,
                                      .judgement = {.verdict = Verdict::kSafe,
                                                    .load_ratio_max = bound.high,
                                                    .load_ratio_high = bound.high,
                                                    .margin_mm = margin_mm,
                                                    .is_bound = true}};
    }
  }
  return places;
}

}  // namespace holdfast::plan
