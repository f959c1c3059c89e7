// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "candidate_judge.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "holdfast/host/team.hpp"

namespace holdfast::plan {
namespace {

/// Of how far bending moves the centre of mass.
constexpr double kSwayRounding = 1e-6;

using base::Vec6;
using solver::kLaneCount;
using solver::LaneBlock;
using verdict::Verdict;

/// Where more blocks than this fill in per module, a solution per candidate takes longer than
/// multigrid's check of it.
constexpr std::size_t kJudgedFillMax = 100;

/// Rounding beyond this share of a load ratio is left to the checks, which refine.
constexpr double kErrorShareMax = 1e-9;

/// What displacements for loads on all facets may take.
constexpr std::size_t kFacetBytesMax = std::size_t{1} << 29U;

/// By which connections are softened, each times its weight: the less the sharper, and the less the
/// more do energies lose to rounding.
constexpr double kSoftening = 1.0 / 16;

/// Softened stiffness takes another factorization. It is worth it where more than one in so many
/// of at least so many candidates would take a whole solution.
constexpr std::size_t kUndecidedShare = 8;
constexpr std::size_t kSampleSize = 64;

/// What a screen takes, in factorizations, times how much cheaper it has to be: two inverses of
/// twice as much each, and a factorization.
constexpr double kScreenProducts = 10;

/// A candidate takes some dense systems of as many unknowns as rows of facets yield, a check some
/// time per module: above so many cubed rows per module checks are faster.
constexpr std::size_t kCubedRowsPerModule = 8000;

/// So many connections, those with the largest load ratios before, are looked at first: mostly the
/// largest afterwards is theirs.
constexpr std::size_t kFirstContenders = 8;

/// Where more than one of so many connections may decide, all displacements are found.
constexpr std::size_t kWholeShare = 2;

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

/// Those where a module is more than a load.
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

/// Those and what they are connected with.
std::vector<std::size_t> with_neighbours(std::vector<std::size_t> modules,
                                         const model::Robot& robot) {
  const std::size_t count = modules.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::int32_t beside : robot.connected()[modules[i]]) {
      if (beside != model::Robot::kNoNeighbour) {
        modules.push_back(base::at(beside));
      }
    }
  }
  return modules;
}

template <class Predicate>
std::size_t count_if(auto& range, const Predicate& predicate) {
  return static_cast<std::size_t>(std::ranges::count_if(range, predicate));
}

double middle_of(std::vector<double>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::size_t yielding_rows(const Grown& grown) {
  std::size_t count = 0;
  for (const Vec6<double>& force : grown.facet_forces) {
    count += static_cast<std::size_t>(
        std::ranges::count_if(force, [](double component) { return component != 0; }));
  }
  return count;
}

/// f' Z f for loads on some modules, and Z between these.
double energy_of(const solver::InverseStiffness& inverse, std::span<const PointLoad> loads) {
  double energy = 0;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Vec6<double> u =
          base::multiply(inverse.between(loads[i].module, loads[j].module), loads[j].load);
      energy += (i == j ? 1 : 2) * base::dot(loads[i].load, u);
    }
  }
  return energy;
}

}  // namespace

std::unique_ptr<CandidateJudge> CandidateJudge::make(const model::RobotSpec& spec,
                                                     const RobotSymmetry& symmetry,
                                                     const CandidateOptions& options) {
  auto robot = model::Robot::create(spec, options.equilibrium.thread_count);
  if (!robot) {
    return nullptr;
  }
  std::unique_ptr<CandidateJudge> judge(
      new CandidateJudge(spec, options, std::move(robot).value()));
  return judge->prepare(symmetry) ? std::move(judge) : nullptr;
}

CandidateJudge::CandidateJudge(const model::RobotSpec& spec, const CandidateOptions& options,
                               model::Robot robot)
    : spec_(spec),
      options_(options),
      robot_(std::move(robot)),
      finder_(robot_, spec),
      rigid_(robot_, robot_.kinds().front().mass_kg),
      is_held_(robot_.fixed_count() > 0 || robot_.has_bonded_facets()) {}

/// False if nothing can be judged without checks.
bool CandidateJudge::prepare(const RobotSymmetry& symmetry) {
  if (!is_held_ && !finder_.has_polygon() && !options_.equilibrium.is_bonded) {
    return false;
  }
  for (const base::Cell& cell : free_cells(spec_)) {
    if (symmetry.representative(cell) != cell) {
      continue;
    }
    Site site = finder_.find(cell);
    if (site.kind == Site::Kind::kOpen) {
      sites_.push_back(std::move(site));
    }
  }
  hosts_ = hosts_of(sites_);
  solver::EquilibriumOptions direct = options_.equilibrium;
  direct.method = solver::Method::kDirect;
  direct.fill_max = kJudgedFillMax;
  influence_ = solver::Influence::make(robot_, direct);
  if (!influence_) {
    return false;
  }
  ratios_.emplace(robot_, *influence_);
  if (!(ratios_->error_share() <= kErrorShareMax)) {
    return false;
  }
  contact_.emplace(robot_, spec_.floor, *influence_, options_.equilibrium.is_bonded, sites_);
  begins_stuck_ = is_stuck();
  find_inverse();
  find_sway();
  return make_screen();
}

/// How loads move the centre of mass along x and y: by Maxwell and Betti as masses that pull there
/// move the modules.
void CandidateJudge::find_sway() {
  if (is_held_ || !finder_.has_polygon() || options_.equilibrium.is_bonded) {
    return;
  }
  std::vector<LaneBlock> pulls(influence_->slot_count());
  const auto& displacement = influence_->displacement();
  for (std::size_t module = 0; module < displacement.size(); ++module) {
    const double mass = robot_.mass(module);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      pulls[influence_->slot(module)].values[axis][axis] += mass;
    }
    moved_alone_.add(mass, displacement[module][0], displacement[module][1]);
  }
  influence_->solve(pulls);
  sway_.resize(displacement.size());
  for (std::size_t module = 0; module < displacement.size(); ++module) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t k = 0; k < 6; ++k) {
        sway_[module][axis][k] = pulls[influence_->slot(module)].values[k][axis];
      }
    }
  }
}

/// Whether bending surely leaves the centre of mass over the polygon, where the new module moves by
/// `own`: else a check decides, and says so.
bool CandidateJudge::stays_over_polygon(const Waiting& waiting, const Vec6<double>& own) const {
  if (sway_.empty()) {
    return true;
  }
  verdict::MovedMass moved = moved_alone_;
  moved.add(robot_.material().mass_kg, own[0], own[1]);
  for (const PointLoad& point : loads_of(waiting.grown)) {
    moved.x_kg_mm += base::dot(sway_[point.module][0], point.load);
    moved.y_kg_mm += base::dot(sway_[point.module][1], point.load);
  }
  return waiting.margin_mm && moved.shift_mm() * (1 + kSwayRounding) < *waiting.margin_mm;
}

/// What bounds need of K^-1 and of that of a softened robot takes some factorizations: worth it
/// where whole solutions for all candidates take several times as much.
bool CandidateJudge::may_screen() const {
  const double whole = static_cast<double>(sites_.size()) * influence_->solution_product_count();
  return kScreenProducts * static_cast<double>(influence_->factor_product_count()) <= whole;
}

void CandidateJudge::find_inverse() {
  const bool is_for_all = may_screen();
  const std::vector<Site> sites = is_for_all ? sites_ : stiffening(sites_);
  const std::vector<std::size_t> hosts = hosts_of(sites);
  const std::vector<std::size_t> modules = is_for_all ? with_neighbours(hosts, robot_) : hosts;
  const std::vector<solver::Edge> pairs = pairs_of(sites);
  influence_->find_inverse({.modules = modules,
                            .pairs = pairs,
                            .is_any_connected = is_for_all,
                            .thread_count = options_.equilibrium.thread_count});
}

bool CandidateJudge::is_stuck() const {
  const auto& displacement = influence_->displacement();
  return options_.equilibrium.is_bonded ||
         std::ranges::all_of(influence_->facets(), [&](const solver::FacetState& facet) {
           return influence_->law().state_at(facet, displacement[facet.module]) ==
                  mechanics::kStuck;
         });
}

/// From the robot without candidates, in its own contact states; false if checks are faster.
bool CandidateJudge::make_screen() {
  std::vector<Vec6<double>> displacement = influence_->displacement();
  if (begins_stuck_) {
    alone_.emplace();
  } else {
    alone_ = settled({});
    if (!alone_) {
      return true;
    }
    const std::size_t rows = yielding_rows(*alone_);
    if (rows * rows * rows > kCubedRowsPerModule * robot_.modules().size()) {
      return false;
    }
  }
  if (!may_screen()) {
    return true;
  }
  if (!begins_stuck_) {
    std::vector<LaneBlock> more(influence_->slot_count());
    for (const PointLoad& point : loads_of(*alone_)) {
      for (std::size_t k = 0; k < 6; ++k) {
        more[influence_->slot(point.module)].values[k][0] += point.load[k];
      }
    }
    influence_->solve(more);
    for (std::size_t module = 0; module < displacement.size(); ++module) {
      displacement[module] = this->displacement(module, 0, more);
    }
  }
  screen_.emplace(robot_, *influence_, displacement);
  sharpen_screen();
  return true;
}

/// Makes bounds sharper, as far as a sample of the candidates says that it is worth it.
void CandidateJudge::sharpen_screen() {
  std::vector<Waiting> sample;
  std::vector<double> energies;
  std::vector<double> ratios;
  const std::size_t stride = std::max<std::size_t>(1, sites_.size() / kSampleSize);
  for (std::size_t i = 0; i < sites_.size(); i += stride) {
    std::optional<Candidate> judged;
    if (auto waiting = look_at(sites_[i].cell, judged)) {
      std::vector<PointLoad> loads;
      energies.push_back(change_of(waiting->grown, loads).energy);
      const auto hosts = host_displacements(waiting->grown);
      ratios.push_back(new_ratio(sites_[i], hosts, waiting->grown.node->displacement(hosts)));
      sample.push_back(*std::move(waiting));
    }
  }
  if (sample.empty()) {
    return;
  }
  const double target = std::max(middle_of(ratios), screen_->ratio_max());
  screen_->keep_columns(target, energies, sites_.size());
  if (!begins_stuck_) {
    return;
  }
  const auto is_undecided = [&](const Waiting& waiting) { return !bounded(waiting).has_value(); };
  if (target > 0 && sites_.size() > kSampleSize &&
      kUndecidedShare * count_if(sample, is_undecided) > sample.size()) {
    soften(target);
  }
  if (2 * count_if(sample, is_undecided) > sample.size()) {
    screen_.reset();  // What it saves is less than what it takes.
    return;
  }
  const std::size_t uncertain_count =
      count_if(sample, [&](const Waiting& waiting) { return !sticks(waiting); });
  // Of each facet six solutions, or one of each candidate whose facets are uncertain.
  if (6 * influence_->facets().size() * sample.size() < uncertain_count * sites_.size()) {
    screen_facets_ = facets();
  }
  if (2 * count_if(sample, [&](Waiting& waiting) { return !screened(waiting).has_value(); }) >
      sample.size()) {
    screen_.reset();
  }
}

/// Softer connections, K - s sum of w_e K_e, take up more energy from the same loads f: with
/// phi(s) = f' (K - s sum of w_e K_e)^-1 f the energies e_e of the connections are bounded by
///   sum of w_e e_e = phi'(0) <= (phi(s) - phi(0)) / s,   as phi is convex.
void CandidateJudge::soften(double target) {
  std::vector<double> weights = screen_->weights(target);
  std::vector<double> factors;
  std::ranges::transform(weights, std::back_inserter(factors),
                         [](double weight) { return 1 - kSoftening * weight; });
  softened_ = influence_->inverse_of(
      factors, {.modules = hosts_, .thread_count = options_.equilibrium.thread_count});
  screen_->set_weights(std::move(weights));
}

std::size_t CandidateJudge::judge(std::span<const base::Cell> cells,
                                  std::span<std::optional<Candidate>> judged) const {
  std::vector<std::optional<Waiting>> undecided(cells.size());
  host::Team team(options_.equilibrium.thread_count, cells.size());
  team.share(0, cells.size(), [&](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) {
      auto waiting = look_at(cells[begin], judged[begin]);
      const auto found = waiting ? screened(*waiting) : std::nullopt;
      if (found) {
        conclude(*waiting, found->ratio, found->own);
      } else {
        undecided[begin] = std::move(waiting);
      }
    }
  });
  std::vector<Waiting> waiting;
  for (std::optional<Waiting>& one : undecided) {
    if (one) {
      waiting.push_back(*std::move(one));
    }
  }
  const std::size_t count = waiting.size();
  judge_fully(std::move(waiting));
  return count;
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

std::optional<Grown> CandidateJudge::settled(const Site& site) const {
  const FacetInfluence* const known = facets();
  auto grown = known != nullptr ? contact_->settle(site, *known) : std::nullopt;
  return grown && grown->footing.is_certain ? std::move(grown) : std::nullopt;
}

/// What the rigid body alone decides; what is left goes on to loads.
std::optional<CandidateJudge::Waiting> CandidateJudge::look_at(
    const base::Cell& cell, std::optional<Candidate>& judged) const {
  Site site = finder_.find(cell);
  if (site.kind == Site::Kind::kUnknown) {
    return std::nullopt;
  }
  if (site.kind == Site::Kind::kImpossible || !has_host_for(site)) {
    judged = Candidate{.cell = site.cell};
    return std::nullopt;
  }
  const verdict::RigidBody body = rigid_.with(site.cell, site.is_on_floor);
  if (!body.is_stable && !options_.equilibrium.is_bonded) {
    judged = Candidate{.cell = site.cell,
                       .is_robot = true,
                       .judgement = {.verdict = Verdict::kUnstable, .margin_mm = body.margin_mm}};
    return std::nullopt;
  }
  auto grown = begins_stuck_ ? contact_->stuck(site) : settled(site);
  if (!grown) {
    return std::nullopt;
  }
  return Waiting{.site = std::move(site),
                 .grown = *std::move(grown),
                 .margin_mm = body.margin_mm,
                 .result = &judged};
}

/// The loads of the new module, and by how much facets bear more than without it.
LoadChange CandidateJudge::change_of(const Grown& grown, std::vector<PointLoad>& loads) const {
  loads = grown.host_loads;
  LoadChange change{.energy = energy_of(influence_->inverse(), loads)};
  if (softened_ && loads.size() == 1 && grown.facet_forces.empty()) {
    change.weighted_energy = (energy_of(*softened_, loads) - change.energy) / kSoftening;
  }
  const bool has_facets = !grown.facet_forces.empty() || !alone_->facet_forces.empty();
  const std::size_t facet_count = has_facets ? influence_->facets().size() : 0;
  std::vector<std::size_t> changed;
  std::vector<Vec6<double>> forces(facet_count);
  for (std::size_t facet = 0; facet < facet_count; ++facet) {
    for (std::size_t k = 0; k < 6; ++k) {
      forces[facet][k] = (grown.facet_forces.empty() ? 0 : grown.facet_forces[facet][k]) -
                         (alone_->facet_forces.empty() ? 0 : alone_->facet_forces[facet][k]);
    }
    if (forces[facet] != Vec6<double>{}) {
      changed.push_back(facet);
      loads.push_back({.module = influence_->facets()[facet].module,
                       .load = facets_->load(facet, forces[facet])});
    }
  }
  for (const std::size_t facet : changed) {
    Vec6<double> motion{};  // Of the facet, under all forces on facets and twice those on hosts.
    for (const std::size_t other : changed) {
      base::add_to(motion, base::multiply(facets_->between(facet, other), forces[other]));
    }
    for (const PointLoad& point : grown.host_loads) {
      for (std::size_t i = 0; i < 6; ++i) {
        motion[i] += 2 * base::dot(facets_->displacement(point.module, facet, i), point.load);
      }
    }
    change.energy += base::dot(forces[facet], motion);
  }
  return change;
}

/// Whether all facets surely stick, as they do without the new module.
bool CandidateJudge::sticks(const Waiting& waiting) const {
  const std::vector<PointLoad>& loads = waiting.grown.host_loads;
  const auto hosts = host_displacements(waiting.grown);
  const Footing footing = contact_->footing_if_stuck(
      waiting.site, waiting.grown.node->displacement(hosts), loads,
      std::sqrt(energy_of(influence_->inverse(), loads)), screen_facets_);
  return footing.is_certain && !footing.is_slipping;
}

/// The largest load ratio, where bounds suffice to know it. Settles the facets if need be.
std::optional<CandidateJudge::Bounded> CandidateJudge::screened(Waiting& waiting) const {
  if (!screen_) {
    return std::nullopt;
  }
  if (begins_stuck_ && !waiting.grown.is_settled && !sticks(waiting)) {
    auto grown = screen_facets_ != nullptr ? settled(waiting.site) : std::nullopt;
    if (!grown) {
      return std::nullopt;
    }
    waiting.grown = *std::move(grown);
  }
  return bounded(waiting);
}

/// The largest load ratio in the contact states found so far, as far as bounds tell.
std::optional<CandidateJudge::Bounded> CandidateJudge::bounded(const Waiting& waiting) const {
  std::vector<PointLoad> loads;
  LoadChange change = change_of(waiting.grown, loads);
  change.loads = loads;
  const auto hosts = host_displacements(waiting.grown);
  const Vec6<double> own = waiting.grown.node->displacement(hosts);
  const auto ratio = screen_->largest(change, new_ratio(waiting.site, hosts, own));
  return ratio ? std::optional(Bounded{*ratio, own}) : std::nullopt;
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

/// Those whose facets turn out not to stick, though those of the robot without them do, come
/// `again`, settled.
void CandidateJudge::judge_together(std::span<Waiting> lanes, std::vector<Waiting>& again) const {
  std::vector<LaneBlock> more(influence_->slot_count());
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    for (const PointLoad& point : loads_of(lanes[lane].grown)) {
      for (std::size_t k = 0; k < 6; ++k) {
        more[influence_->slot(point.module)].values[k][lane] += point.load[k];
      }
    }
  }
  const Solved solved = solve_where_it_matters(lanes, more);
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    Waiting& one = lanes[lane];
    const auto hosts = host_displacements(one, lane, more);
    const Vec6<double> own = one.grown.node->displacement(hosts);
    if (!one.grown.is_settled) {
      one.grown.footing = contact_->footing_if_stuck(
          one.site, own, solved.facet_count,
          [&](std::size_t module) { return displacement(module, lane, more); });
      if (!one.grown.footing.is_certain) {
        if (auto grown = settled(one.site)) {
          one.grown = *std::move(grown);
          again.push_back(std::move(one));
        }
        continue;
      }
    }
    conclude(one, std::max(solved.largest[lane], new_ratio(one.site, hosts, own)), own);
  }
}

/// The displacements of hosts, and of the ends of all connections and facets that matter. By the
/// energy of the loads all other facets stick, and no other connection has a larger load ratio than
/// the largest of those that have the largest ones before.
CandidateJudge::Solved CandidateJudge::solve_where_it_matters(std::span<const Waiting> lanes,
                                                              std::span<LaneBlock> more) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const solver::LaneNumbers energies = influence_->begin_solution(more);
  std::vector<std::size_t> slots;
  for (const Waiting& one : lanes) {
    for (const Link& link : one.site.links) {
      slots.push_back(influence_->slot(link.host));
    }
  }
  const std::size_t first_count = std::min(kFirstContenders, ratios_->connection_count());
  ratios_->add_slots(first_count, slots);
  std::vector<std::uint8_t> is_found;
  influence_->find_solution(more, slots, is_found);
  Solved solved;
  solved.largest.fill(-kInfinity);
  solved.largest = ratios_->largest(more, 0, first_count, solved.largest);
  std::size_t count = first_count;
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    const double root = std::isnan(energies[lane]) ? kInfinity : std::sqrt(energies[lane]);
    count = std::max(count, ratios_->contender_count(solved.largest[lane], root));
    if (!lanes[lane].grown.is_settled) {
      solved.facet_count = std::max(solved.facet_count, contact_->uncertain_count(root));
    }
  }
  if (kWholeShare * count > ratios_->connection_count()) {
    influence_->end_solution(more, is_found);
  } else {
    slots.clear();
    ratios_->add_slots(count, slots);
    for (std::size_t i = 0; i < solved.facet_count; ++i) {
      slots.push_back(influence_->slot(contact_->uncertain_module(i)));
    }
    influence_->find_solution(more, slots, is_found);
  }
  solved.largest = ratios_->largest(more, first_count, count, solved.largest);
  return solved;
}

void CandidateJudge::conclude(const Waiting& waiting, double ratio, const Vec6<double>& own) const {
  const double doubt = kNearLimit * std::max(1.0, std::abs(ratio));
  if (!std::isfinite(ratio) || std::abs(ratio - 1) <= doubt) {
    return;
  }
  if (ratio < 1 && !stays_over_polygon(waiting, own)) {
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

/// On hosts and on facets that do not stick.
std::vector<PointLoad> CandidateJudge::loads_of(const Grown& grown) const {
  std::vector<PointLoad> loads = grown.host_loads;
  for (std::size_t facet = 0; facet < grown.facet_forces.size(); ++facet) {
    loads.push_back({.module = influence_->facets()[facet].module,
                     .load = facets_->load(facet, grown.facet_forces[facet])});
  }
  return loads;
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

/// The same from the blocks of K^-1 between them, and the facets' influence on them.
std::vector<Vec6<double>> CandidateJudge::host_displacements(const Grown& grown) const {
  std::vector<Vec6<double>> hosts;
  for (const PointLoad& host : grown.host_loads) {
    Vec6<double> u = influence_->displacement()[host.module];
    for (const PointLoad& point : grown.host_loads) {
      base::add_to(
          u, base::multiply(influence_->inverse().between(host.module, point.module), point.load));
    }
    for (std::size_t facet = 0; facet < grown.facet_forces.size(); ++facet) {
      for (std::size_t i = 0; i < 6; ++i) {
        const Vec6<double>& column = facets_->displacement(host.module, facet, i);
        for (std::size_t k = 0; k < 6; ++k) {
          u[k] += grown.facet_forces[facet][i] * column[k];
        }
      }
    }
    hosts.push_back(u);
  }
  return hosts;
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
