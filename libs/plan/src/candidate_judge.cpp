// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "candidate_judge.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "holdfast/host/team.hpp"

namespace holdfast::plan {
namespace {

using base::Vec6;
using solver::kLaneCount;
using solver::LaneBlock;
using verdict::Verdict;

/// Where more blocks than this fill in per module, a solution per candidate takes longer than
/// multigrid's check of it.
constexpr std::size_t kFillMax = 100;

/// Rounding beyond this share of a load ratio is left to the checks, which refine.
constexpr double kErrorShareMax = 1e-9;

/// What displacements for loads on all facets may take.
constexpr std::size_t kFacetBytesMax = std::size_t{1} << 29U;

}  // namespace

std::unique_ptr<CandidateJudge> CandidateJudge::make(const model::RobotSpec& spec,
                                                     const CandidateOptions& options) {
  auto robot = model::Robot::create(spec, options.equilibrium.thread_count);
  if (!robot) {
    return nullptr;
  }
  std::unique_ptr<CandidateJudge> judge(
      new CandidateJudge(spec, options, std::move(robot).value()));
  return judge->prepare() ? std::move(judge) : nullptr;
}

CandidateJudge::CandidateJudge(const model::RobotSpec& spec, const CandidateOptions& options,
                               model::Robot robot)
    : spec_(spec),
      options_(options),
      robot_(std::move(robot)),
      sites_(robot_, spec),
      rigid_(robot_, robot_.kinds().front().mass_kg),
      is_held_(robot_.fixed_count() > 0 || robot_.has_bonded_facets()) {}

/// False if nothing can be judged without checks.
bool CandidateJudge::prepare() {
  const bool is_polygon = verdict::is_on_flat_floor(robot_);
  if (!is_held_ && !is_polygon && !options_.equilibrium.is_bonded) {
    return false;
  }
  solver::EquilibriumOptions direct = options_.equilibrium;
  direct.method = solver::Method::kDirect;
  direct.fill_max = kFillMax;
  influence_ = solver::Influence::make(robot_, direct);
  if (!influence_) {
    return false;
  }
  ratios_.emplace(robot_, *influence_);
  contact_.emplace(robot_, spec_.floor, *influence_, options_.equilibrium.is_bonded);
  begins_stuck_ = is_stuck();
  return ratios_->error_share() <= kErrorShareMax;
}

bool CandidateJudge::is_stuck() const {
  const auto& displacement = influence_->displacement();
  return options_.equilibrium.is_bonded ||
         std::ranges::all_of(influence_->facets(), [&](const solver::FacetState& facet) {
           return influence_->law().state_at(facet, displacement[facet.module]) ==
                  mechanics::ContactState{};
         });
}

void CandidateJudge::judge(std::span<const base::Cell> cells,
                           std::span<std::optional<Candidate>> judged) const {
  host::Team team(options_.equilibrium.thread_count, cells.size());
  team.share(0, cells.size(), [&](std::size_t begin, std::size_t end) {
    for (; begin < end; begin += host::Team::kChunk) {
      const std::size_t count = std::min(end - begin, host::Team::kChunk);
      judge_part(cells.subspan(begin, count), judged.subspan(begin, count));
    }
  });
}

bool CandidateJudge::has_host_for(const Site& site) const {
  return options_.is_planned || std::ranges::any_of(site.links, [&](const Link& link) {
           return !robot_.modules()[link.host].is_planned;
         });
}

const FacetInfluence* CandidateJudge::facets() const {
  std::call_once(facets_made_, [&] {
    facets_ = FacetInfluence::make(*influence_,
                                   std::min(kFacetBytesMax, options_.equilibrium.memory_bytes_max));
  });
  return facets_.get();
}

std::optional<Grown> CandidateJudge::settled(const Site& site, ReachCache& reaches) const {
  const FacetInfluence* const known = facets();
  auto grown = known != nullptr ? contact_->settle(site, reaches, *known) : std::nullopt;
  return grown && grown->footing.is_certain ? std::move(grown) : std::nullopt;
}

/// What the rigid body alone decides, and the loads of all others.
void CandidateJudge::judge_part(std::span<const base::Cell> cells,
                                std::span<std::optional<Candidate>> judged) const {
  ReachCache reaches;
  std::vector<Waiting> waiting;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Site site = sites_.find(cells[i]);
    if (site.kind == Site::Kind::kUnknown) {
      continue;
    }
    if (site.kind == Site::Kind::kImpossible || !has_host_for(site)) {
      judged[i] = Candidate{.cell = cells[i]};
      continue;
    }
    const verdict::RigidBody body = rigid_.with(cells[i], site.is_on_floor);
    if (!body.is_stable && !options_.equilibrium.is_bonded) {
      judged[i] =
          Candidate{.cell = cells[i],
                    .is_robot = true,
                    .judgement = {.verdict = Verdict::kUnstable, .margin_mm = body.margin_mm}};
      continue;
    }
    auto grown = begins_stuck_ ? contact_->stuck(site, reaches) : settled(site, reaches);
    if (grown) {
      waiting.push_back({.site = std::move(site),
                         .grown = *std::move(grown),
                         .margin_mm = body.margin_mm,
                         .result = &judged[i]});
    }
  }
  judge_together(waiting, reaches);
}

/// Lanes by lanes.
void CandidateJudge::judge_together(std::span<Waiting> waiting, ReachCache& reaches) const {
  std::vector<LaneBlock> more;
  std::vector<Waiting> again;
  for (std::size_t first = 0; first < waiting.size(); first += kLaneCount) {
    const auto lanes = waiting.subspan(first, std::min(kLaneCount, waiting.size() - first));
    more.assign(influence_->slot_count(), {});
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
      for (const PointLoad& point : lanes[lane].grown.loads) {
        for (std::size_t k = 0; k < 6; ++k) {
          more[influence_->slot(point.module)].values[k][lane] += point.load[k];
        }
      }
    }
    influence_->solve(more);
    const LaneRatios::PerLane largest = ratios_->largest(more);
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
      Waiting& one = lanes[lane];
      if (begins_stuck_ && !one.grown.is_settled) {
        const auto hosts = host_displacements(one, lane, more);
        one.grown.footing = contact_->footing_if_stuck(
            one.site, one.grown.node.displacement(hosts),
            [&](std::size_t module) { return displacement(module, lane, more); });
        if (!one.grown.footing.is_certain) {
          again.push_back(std::move(one));
          continue;
        }
      }
      conclude(one, std::max(largest[lane], new_ratio(one, lane, more)));
    }
  }
  look_again(again, reaches);
}

/// Those whose facets are not all stuck, though those of the robot without them are.
void CandidateJudge::look_again(std::span<Waiting> waiting, ReachCache& reaches) const {
  std::vector<Waiting> found;
  for (Waiting& one : waiting) {
    if (auto grown = settled(one.site, reaches)) {
      one.grown = *std::move(grown);
      found.push_back(std::move(one));
    }
  }
  if (!found.empty()) {
    judge_together(found, reaches);
  }
}

void CandidateJudge::conclude(const Waiting& waiting, double ratio) const {
  const double doubt = kNearLimit * std::max(1.0, std::abs(ratio));
  if (!std::isfinite(ratio) || std::abs(ratio - 1) <= doubt) {
    return;
  }
  const Verdict loaded = ratio > 1 ? Verdict::kOverload : Verdict::kSafe;
  *waiting.result = Candidate{
      .cell = waiting.site.cell,
      .is_robot = true,
      .judgement = {.verdict = waiting.grown.footing.is_slipping ? Verdict::kUndecided : loaded,
                    .load_ratio_max = ratio,
                    .margin_mm = waiting.margin_mm}};
}

Vec6<double> CandidateJudge::displacement(std::size_t module, std::size_t lane,
                                          std::span<const LaneBlock> more) const {
  Vec6<double> u = influence_->displacement()[module];
  const LaneBlock& block = more[influence_->slot(module)];
  for (std::size_t k = 0; k < 6; ++k) {
    u[k] += block.values[k][lane];
  }
  return u;
}

std::vector<Vec6<double>> CandidateJudge::host_displacements(
    const Waiting& waiting, std::size_t lane, std::span<const LaneBlock> more) const {
  std::vector<Vec6<double>> hosts;
  for (const Link& link : waiting.site.links) {
    hosts.push_back(displacement(link.host, lane, more));
  }
  return hosts;
}

/// The largest load ratio of the new connections.
double CandidateJudge::new_ratio(const Waiting& waiting, std::size_t lane,
                                 std::span<const LaneBlock> more) const {
  const auto hosts = host_displacements(waiting, lane, more);
  const Vec6<double> own = waiting.grown.node.displacement(hosts);
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t h = 0; h < hosts.size(); ++h) {
    const Link& link = waiting.site.links[h];
    const std::size_t kind = robot_.modules()[link.host].kind;
    const bool is_first = base::index(link.direction) % 2 == 0;
    const base::Direction direction = is_first ? link.direction : base::opposite(link.direction);
    const model::ConnectorLaw& law =
        is_first ? robot_.connector(kind, 0, direction) : robot_.connector(0, kind, direction);
    const Vec6<double> force = is_first ? influence_->beam().middle_force(direction, hosts[h], own)
                                        : influence_->beam().middle_force(direction, own, hosts[h]);
    largest = std::max(largest, model::load_ratio(law, force).ratio);
  }
  return largest;
}

}  // namespace holdfast::plan
