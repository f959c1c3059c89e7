// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "judges/candidate_judge.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "holdfast/host/team.hpp"
#include "own_solution.hpp"

namespace holdfast::plan {
namespace {

/// Rounding in how far bending moves the centre of mass, as a share.
constexpr double kSwayRounding = 1e-6;

using base::Vec6;
using solver::kLaneCount;
using solver::LaneBlock;
using verdict::Verdict;

/// What displacements for loads on all facets may take.
constexpr std::size_t kFacetBytesMax = std::size_t{1} << 29U;

/// A candidate takes some dense systems of as many unknowns as rows of facets yield, a check some
/// time per module: above so many cubed rows per module checks are faster.
constexpr std::size_t kCubedRowsPerModule = 8000;

/// Pairs of hosts of one site, each pair once.
std::vector<solver::Edge> pairs_of(const std::vector<Site>& sites) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Site& site : sites) {
    for (std::size_t i = 0; i < site.links.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        pairs.emplace_back(std::minmax({site.links[i].host, site.links[j].host}));
      }
    }
  }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<solver::Edge> edges;
  for (const auto& [a, b] : pairs) {
    edges.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
  }
  return edges;
}

/// The sites where a module is more than a load.
std::vector<Site> stiffening(const std::vector<Site>& sites) {
  std::vector<Site> some;
  std::ranges::copy_if(sites, std::back_inserter(some),
                       [](const Site& site) { return site.is_on_floor || site.links.size() > 1; });
  return some;
}

std::vector<std::size_t> hosts_of(const std::vector<Site>& sites) {
  std::vector<std::size_t> hosts;
  for (const Site& site : sites) {
    for (const Link& link : site.links) {
      hosts.push_back(link.host);
    }
  }
  std::ranges::sort(hosts);
  hosts.erase(std::unique(hosts.begin(), hosts.end()), hosts.end());
  return hosts;
}

}  // namespace

std::unique_ptr<CandidateJudge> CandidateJudge::make(const model::RobotSpec& spec,
                                                     const RobotSymmetry& symmetry,
                                                     const CandidateOptions& options,
                                                     std::size_t fill_max) {
  auto robot = model::Robot::create(spec, options.equilibrium.thread_count);
  // What bending does takes a solution of each candidate by itself.
  if (!robot || needs_own_solution(robot.value())) {
    return nullptr;
  }
  std::unique_ptr<CandidateJudge> judge(
      new CandidateJudge(spec, options, std::move(robot).value()));
  return judge->prepare(symmetry, fill_max) ? std::move(judge) : nullptr;
}

CandidateJudge::CandidateJudge(const model::RobotSpec& spec, const CandidateOptions& options,
                               model::Robot robot)
    : spec_(spec), options_(options), robot_(std::move(robot)), look_(robot_, spec, options) {}

/// Finds what all candidates share. False if nothing can be judged without checks.
bool CandidateJudge::prepare(const RobotSymmetry& symmetry, std::size_t fill_max) {
  if (!look_.can_judge()) {
    return false;
  }
  for (const base::Cell& cell : free_cells(spec_)) {
    if (symmetry.representative(cell) != cell) {
      continue;
    }
    Site site = look_.finder().find(cell);
    if (site.kind == Site::Kind::kOpen) {
      sites_.push_back(std::move(site));
    }
  }
  solver::EquilibriumOptions direct = options_.equilibrium;
  direct.method = solver::Method::kDirect;
  direct.fill_max = fill_max;
  influence_ = solver::Influence::make(robot_, direct);
  if (!influence_) {
    return false;
  }
  if (!(rounding_share(robot_, *influence_) <= kRoundingShareMax)) {
    return false;
  }
  core_.emplace(*influence_);
  contact_.emplace(robot_, spec_.floor, *core_, options_.equilibrium.is_bonded);
  begins_stuck_ = is_stuck();
  find_inverse();
  find_sway();
  return begins_stuck_ || pays();
}

void CandidateJudge::find_sway() {
  if (!look_.is_held() && look_.finder().has_polygon() && !options_.equilibrium.is_bonded) {
    sway_.emplace(robot_, *influence_);
  }
}

/// Whether bending surely leaves the centre of mass over the polygon, where the new module moves by
/// `own`: else a check decides, and says so.
bool CandidateJudge::stays_over_polygon(const Waiting& waiting, const Vec6<double>& own) const {
  if (!sway_) {
    return true;
  }
  verdict::MovedMass moved = sway_->moved(waiting.grown.loads);
  moved.add(robot_.material().mass_kg, own[0], own[1]);
  return waiting.margin_mm && moved.shift_mm() * (1 + kSwayRounding) < *waiting.margin_mm;
}

/// K^-1 between the hosts of modules that are more than a load.
void CandidateJudge::find_inverse() {
  const std::vector<Site> sites = stiffening(sites_);
  influence_->find_inverse(hosts_of(sites), pairs_of(sites), options_.equilibrium.thread_count);
}

bool CandidateJudge::is_stuck() const {
  const auto& displacement = influence_->displacement();
  return options_.equilibrium.is_bonded ||
         std::ranges::all_of(influence_->facets(), [&](const solver::FacetState& facet) {
           return influence_->law().state_at(facet, displacement[facet.module]) ==
                  mechanics::kStuck;
         });
}

/// Whether candidates of a robot some of whose facets yield take less this way than by checks.
bool CandidateJudge::pays() const {
  const auto alone = settled({});
  const std::size_t rows = alone ? alone->yielding_count : 0;
  return rows * rows * rows <= kCubedRowsPerModule * robot_.modules().size();
}

void CandidateJudge::judge(std::span<const base::Cell> cells,
                           std::span<std::optional<Candidate>> judged) const {
  std::vector<std::optional<Waiting>> found(cells.size());
  host::Team team(options_.equilibrium.thread_count, cells.size());
  team.share(0, cells.size(), [&](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) {
      found[begin] = look_at(cells[begin], judged[begin]);
    }
  });
  std::vector<Waiting> waiting;
  for (std::optional<Waiting>& one : found) {
    if (one) {
      waiting.push_back(*std::move(one));
    }
  }
  judge_fully(std::move(waiting));
}

const SolvedCore* CandidateJudge::core_with_columns() const {
  std::call_once(columns_made_, [&] {
    auto core = std::make_unique<SolvedCore>(*influence_);
    std::vector<std::size_t> modules;
    for (const solver::FacetState& facet : core->facets()) {
      modules.push_back(facet.module);
    }
    if (core->find_columns(modules,
                           std::min(kFacetBytesMax, options_.equilibrium.memory_bytes_max))) {
      core_with_columns_ = std::move(core);
    }
  });
  return core_with_columns_.get();
}

std::optional<Grown> CandidateJudge::settled(const Site& site) const {
  const SolvedCore* const core = core_with_columns();
  auto grown = core != nullptr ? contact_->settle(site, *core) : std::nullopt;
  return grown && grown->footing.is_certain ? std::move(grown) : std::nullopt;
}

/// What the rigid body alone decides; what is left goes on to loads.
std::optional<CandidateJudge::Waiting> CandidateJudge::look_at(
    const base::Cell& cell, std::optional<Candidate>& judged) const {
  RigidLook::Answer look = look_.at(cell);
  if (!look.site) {
    judged = look.decided;
    return std::nullopt;
  }
  auto grown = begins_stuck_ ? contact_->stuck(*look.site) : settled(*look.site);
  if (!grown) {
    return std::nullopt;
  }
  return Waiting{.site = *std::move(look.site),
                 .grown = *std::move(grown),
                 .margin_mm = look.margin_mm,
                 .result = &judged};
}

/// Whole solutions, lanes by lanes: each of these counts as a chunk of a team's work.
void CandidateJudge::judge_fully(std::vector<Waiting> waiting) const {
  // Loads on modules that are eliminated together reach much the same columns.
  std::ranges::stable_sort(waiting, {}, [&](const Waiting& one) {
    return influence_->slot(one.site.links.front().host);
  });
  const std::size_t group_count = (waiting.size() + kLaneCount - 1) / kLaneCount;
  std::vector<std::vector<Waiting>> again(group_count);
  host::Team team(options_.equilibrium.thread_count, group_count * host::Team::kChunk);
  team.each(group_count, [&](std::size_t group) {
    const std::size_t first = group * kLaneCount;
    const std::size_t count = std::min(kLaneCount, waiting.size() - first);
    judge_together(std::span(waiting).subspan(first, count), again[group]);
  });
  std::vector<Waiting> left;
  for (std::vector<Waiting>& group : again) {
    std::ranges::move(group, std::back_inserter(left));
  }
  if (!left.empty()) {
    judge_fully(std::move(left));
  }
}

/// Judges candidates by one solution. Those whose facets turn out not to stick, though those of the
/// robot without them do, go to `again`, settled.
void CandidateJudge::judge_together(std::span<Waiting> lanes, std::vector<Waiting>& again) const {
  std::vector<LaneBlock> more(influence_->slot_count());
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    for (const PointLoad& point : lanes[lane].grown.loads) {
      for (std::size_t k = 0; k < 6; ++k) {
        more[influence_->slot(point.module)].values[k][lane] += point.load[k];
      }
    }
  }
  influence_->solve(more);
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    Waiting& one = lanes[lane];
    const auto hosts = host_displacements(one, lane, more);
    const Vec6<double> own = one.grown.new_modules.displacements(hosts).front();
    if (!one.grown.is_settled) {
      one.grown.footing = contact_->footing_if_stuck(
          one.site, own, [&](std::size_t module) { return displacement(module, lane, more); });
      if (!one.grown.footing.is_certain) {
        if (auto grown = settled(one.site)) {
          one.grown = *std::move(grown);
          again.push_back(std::move(one));
        }
        continue;
      }
    }
    conclude(one, std::max(old_ratio(lane, more), new_ratio(one.site, hosts, own)), own);
  }
}

void CandidateJudge::conclude(const Waiting& waiting, double ratio, const Vec6<double>& own) const {
  const double doubt = kNearLimit * std::max(1.0, std::abs(ratio));
  if (!std::isfinite(ratio) || std::abs(ratio - 1) <= doubt || waiting.grown.footing.is_slipping) {
    return;
  }
  if (ratio < 1 && !stays_over_polygon(waiting, own)) {
    return;
  }
  const Verdict loaded = ratio > 1 ? Verdict::kOverload : Verdict::kSafe;
  *waiting.result = Candidate{
      .cell = waiting.site.cell,
      .is_robot = true,
      .judgement = {.verdict = loaded, .load_ratio_max = ratio, .margin_mm = waiting.margin_mm}};
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

/// The largest load ratio of the robot's own connections.
double CandidateJudge::old_ratio(std::size_t lane, std::span<const LaneBlock> more) const {
  double largest = -std::numeric_limits<double>::infinity();
  for (const model::Connection& pair : robot_.connections()) {
    const Vec6<double> force =
        influence_->beam().middle_force(pair.direction, displacement(base::at(pair.a), lane, more),
                                        displacement(base::at(pair.b), lane, more));
    largest = std::max(largest, model::load_ratio(robot_.connector(pair), force).ratio);
  }
  return largest;
}

/// The largest load ratio of the new connections, where the new module moves by `own`.
double CandidateJudge::new_ratio(const Site& site, std::span<const Vec6<double>> hosts,
                                 const Vec6<double>& own) const {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t h = 0; h < hosts.size(); ++h) {
    const Link& link = site.links[h];
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
