// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "patches/patch_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "equilibria/carried_force.hpp"
#include "holdfast/model/facet_starts.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

/// Bounds nearer to 1 are not trusted, as of EnergyBound.
constexpr double kPatchRatioMax = 1 - 1e-3;

/// What a patch may hold: factors of 140 modules take some 100 ms, of 24 modules 2 ms.
constexpr std::size_t kPatchCountMax = 140;

/// Blocks of all factors that are kept, 300 bytes each.
constexpr std::size_t kKeptBlocksMax = 4'000'000;

/// What of p may be left unbalanced by rounding, as a share of its largest force; and what that may
/// add to an energy.
constexpr double kUnbalanced = 1e-9;
constexpr double kPatchRounding = 1e-9;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double energy_of(const Vec6<double>& force, const Vec6<double>& stiffness) {
  double energy = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    energy += force[k] * force[k] / stiffness[k];
  }
  return energy;
}

}  // namespace

struct PatchBound::Case {
  PatchRegion region;
  std::int32_t hub = PatchRegion::kNone;  ///< None: feet hold the patch.
  std::optional<std::size_t> hub_module = {};
  Vecs loads;  ///< p by row.

  /// A unit of a force that is lost: its load at a row, and what its spring is stiff by.
  struct Unit {
    std::int32_t row = 0;
    Vec load{};
    double stiffness = 0;
  };

  std::vector<Unit> units = {};
};

/// The way of a weight to the ground.
struct PatchBound::Path {
  double energy = 0;
  double ratio = 0;  ///< The largest load ratio of half of it alone.
  double need = 0;   ///< What half of it takes of the room of the facet where it ends.
};

struct PatchBound::Change {
  double gap = 0;   ///< |s - t|^2
  double norm = 0;  ///< |t|^2
  double ratio = -kInfinite;
  double room = kInfinite;
};

PatchBound::PatchBound(const model::Robot& robot, const verdict::Assessment& solved,
                       const LoopBound& loops, bool is_bonded)
    : robot_(robot),
      solved_(solved),
      limits_(loops.limits()),
      is_bonded_(is_bonded),
      beam_(model::beam_section(robot.material()), robot.lattice()),
      blocks_(beam_, robot.lattice()),
      stiffness_(middle_stiffness(beam_)),
      first_facet_(model::facet_starts(robot)),
      to_ground_(robot.modules().size(), PatchRegion::kNone),
      ground_hops_(robot.modules().size(), PatchRegion::kNone) {
  for (const Direction direction : base::facet_directions(robot.lattice())) {
    const auto pulls_of = [&](const auto& force) {
      const auto forces = base::matrix_of<double>(force);
      Pulls pulls{};
      for (int k = 0; k < 6; ++k) {
        for (int i = 0; i < 6; ++i) {
          pulls[at(k)][at(i)] = forces.at(k, i) / stiffness_[at(k)];
        }
      }
      return pulls;
    };
    pulls_.push_back(
        {.first = pulls_of([&](const Vec& u) { return beam_.middle_force(direction, u, {}); }),
         .second = pulls_of([&](const Vec& u) { return beam_.middle_force(direction, {}, u); })});
  }
  std::vector<std::size_t> reached;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    if (robot.modules()[i].support != model::Support::kNone) {
      ground_hops_[i] = 0;
      reached.push_back(i);
    }
    for (const std::size_t axis : {0U, 1U}) {
      moved_[axis] += robot.mass(i) * solved.equilibrium.displacement[i][axis];
    }
  }
  for (std::size_t next = 0; next < reached.size(); ++next) {
    for (const std::int32_t other : robot.connected()[reached[next]]) {
      if (other != model::Robot::kNoNeighbour && ground_hops_[at(other)] < 0) {
        ground_hops_[at(other)] = ground_hops_[reached[next]] + 1;
        to_ground_[at(other)] = static_cast<std::int32_t>(reached[next]);
        reached.push_back(at(other));
      }
    }
  }
  if (limits_.has_polygon && robot.carried().empty()) {
    shrinking_.emplace(robot);
  }
}

/// Whether something fixed takes what a lost beam carries, so that a hub does not take it all.
bool PatchBound::is_beside_fixed(const LostPart& part) const {
  const auto is_fixed = [&](const model::Connection& beam) {
    return robot_.modules()[at(beam.a)].support == model::Support::kFixed ||
           robot_.modules()[at(beam.b)].support == model::Support::kFixed;
  };
  return std::ranges::any_of(part.change.lost_beams, is_fixed) ||
         (part.hanging && is_fixed(*part.hanging));
}

/// Adds what is lost: forces of beams at their ends that are left, or of a foot.
void PatchBound::add_pulls(const LostPart& part, Case& found) const {
  const auto& u = solved_.equilibrium.displacement;
  const auto add = [&](std::size_t module, const Vec& force, const Pulls& pulls) {
    const std::int32_t row = found.region.row_of(module);
    if (row == PatchRegion::kNone || row == found.hub) {
      return;  // Fixed modules need no balance; at the hub the rest follows.
    }
    for (std::size_t k = 0; k < 6; ++k) {
      base::add_times(found.loads[at(row)], force[k], pulls[k]);
      found.units.push_back({row, pulls[k], stiffness_[k]});
    }
  };
  const auto add_beam = [&](const model::Connection& beam) {
    const std::size_t a = at(beam.a);
    const std::size_t b = at(beam.b);
    const Vec force = beam_.middle_force(beam.direction, u[a], u[b]);
    const BeamPulls& pulls = pulls_[at(base::index(beam.direction))];
    add(a, force, pulls.first);
    add(b, force, pulls.second);
  };
  for (const model::Connection& beam : part.change.lost_beams) {
    add_beam(beam);
  }
  if (part.hanging) {
    add_beam(*part.hanging);
  }
  for (const std::size_t lost : part.change.lost_facets) {
    if (!part.module) {
      const model::Facet& facet = robot_.facets()[lost];
      const std::size_t module = at(facet.module);
      add(module, beam_.middle_force(facet.direction, u[module], {}),
          pulls_[at(base::index(facet.direction))].first);
    }
  }
}

/// The hub of a module is the neighbour that is nearest to the ground; both ends of a connection
/// could be one.
std::optional<PatchBound::Case> PatchBound::case_of(const LostPart& part, int hops,
                                                    bool is_by_hub) const {
  auto region = region_around(robot_, part, first_facet_, hops, kPatchCountMax);
  if (!region) {
    return std::nullopt;
  }
  Case found{.region = *std::move(region), .loads = {}};
  found.loads.resize(found.region.modules.size());
  if (is_by_hub ? !part.change.lost_facets.empty() || is_beside_fixed(part)
                : found.region.feet.empty()) {
    return std::nullopt;
  }
  if (is_by_hub) {
    std::size_t hub =
        at(part.change.lost_beams.empty() ? part.hanging->a : part.change.lost_beams.front().a);
    if (part.module) {
      hub = at(to_ground_[*part.module]);
    }
    found.hub_module = hub;
    found.hub = found.region.row_of(hub);
    if (found.hub == PatchRegion::kNone) {
      return std::nullopt;
    }
  }
  add_pulls(part, found);
  return found;
}

/// The answer of the patch to loads that are balanced within it; the hub stands still.
std::optional<PatchBound::Vecs> PatchBound::open_answer(const Case& found, const Factors& factors,
                                                        Vecs loads) const {
  Vecs v = loads;
  if (found.hub != PatchRegion::kNone) {
    v.erase(v.begin() + found.hub);
  }
  factors.open->solve(v);
  if (found.hub != PatchRegion::kNone) {
    v.insert(v.begin() + found.hub, Vec{});
  }
  return is_balanced(found, v, loads) ? std::optional(std::move(v)) : std::nullopt;
}

/// The loads less what the forces within the patch balance that displacements make.
PatchBound::Vecs PatchBound::unbalanced(const Case& found, const Vecs& v, Vecs loads) const {
  const auto take = [&](std::int32_t row, const Vec& force, const Pulls& pulls) {
    for (std::size_t k = 0; k < 6; ++k) {
      base::add_times(loads[at(row)], -force[k], pulls[k]);
    }
  };
  for (const PatchRegion::Beam& beam : found.region.beams) {
    if (beam.is_inside()) {
      const Vec force = beam_.middle_force(beam.pair.direction, v[at(beam.a)], v[at(beam.b)]);
      const BeamPulls& pulls = pulls_[at(base::index(beam.pair.direction))];
      take(beam.a, force, pulls.first);
      take(beam.b, force, pulls.second);
    }
  }
  for (const PatchRegion::Foot& foot : found.region.feet) {
    if (found.hub != PatchRegion::kNone) {
      break;  // The hub takes what feet could.
    }
    const Direction direction = robot_.facets()[foot.facet].direction;
    take(foot.row, beam_.middle_force(direction, v[at(foot.row)], {}),
         pulls_[at(base::index(direction))].first);
  }
  return loads;
}

/// Whether loads are balanced everywhere but at the hub.
bool PatchBound::is_balanced(const Case& found, const Vecs& v, const Vecs& loads) const {
  const Vecs rest = unbalanced(found, v, loads);
  const double pitch = robot_.material().pitch_mm;
  const auto size = [&](const Vec& load) {
    return std::hypot(load[0], load[1], load[2]) + std::hypot(load[3], load[4], load[5]) / pitch;
  };
  double largest = 0;
  double left = 0;
  for (std::size_t row = 0; row < rest.size(); ++row) {
    largest = std::max(largest, size(loads[row]));
    left = static_cast<std::int32_t>(row) == found.hub ? left : std::max(left, size(rest[row]));
  }
  return left <= kUnbalanced * largest;
}

std::shared_ptr<const PatchBound::Factors> PatchBound::factored(const Case& found) const {
  auto factors = std::make_shared<Factors>();
  factors->closed = found.region.closed(blocks_, robot_);
  factors->open = found.region.open(blocks_, robot_, found.hub);
  if (!factors->closed || !factors->open) {
    factors->open.reset();
    return factors;
  }
  for (const Case::Unit& unit : found.units) {
    Vecs loads(found.loads.size());
    loads[at(unit.row)] = unit.load;
    const auto v = open_answer(found, *factors, loads);
    factors->units += v ? unit.stiffness * base::dot(unit.load, (*v)[at(unit.row)]) : kInfinite;
  }
  return factors;
}

std::shared_ptr<const PatchBound::Factors> PatchBound::factors_of(const Case& found) const {
  std::string key = found.region.key(robot_);
  key.push_back(static_cast<char>(found.hub & 0xff));
  for (const Case::Unit& unit : found.units) {
    key.push_back(static_cast<char>(unit.row & 0xff));
    for (const double number : unit.load) {
      key.append(reinterpret_cast<const char*>(&number), sizeof(number));
    }
  }
  {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(key);
    if (known != known_.end()) {
      return known->second;
    }
  }
  auto factors = factored(found);
  const std::size_t blocks =
      factors->open ? factors->open->lower_block_count() + factors->closed->lower_block_count() : 1;
  const std::lock_guard lock(mutex_);
  if (known_blocks_ + blocks <= kKeptBlocksMax) {
    known_blocks_ += blocks;
    known_.emplace(std::move(key), factors);
  }
  return factors;
}

/// The energy norm that leaves a facet stuck which carries a force.
double PatchBound::slack(const model::Facet& facet, const Vec& force) const {
  if (is_bonded_ || facet.is_bonded()) {
    return kInfinite;
  }
  const double b = robot_.foot_half_width_mm();
  double least = kInfinite;
  for (const std::size_t axis : {3U, 4U}) {
    const double per_norm = std::sqrt(stiffness_[axis] + stiffness_[2] * b * b);
    least = std::min(least, (-force[2] * b - std::abs(force[axis])) / per_norm);
  }
  return least - limits_.error;
}

PatchBound::Change PatchBound::change_of(const Case& found, const Vecs& open,
                                         const Vecs& closed) const {
  Change change;
  const auto& u = solved_.equilibrium.displacement;
  const auto moved = [](const Vecs& v, std::int32_t row) {
    return row == PatchRegion::kNone ? Vec{} : v[at(row)];
  };
  for (const PatchRegion::Beam& beam : found.region.beams) {
    const Direction direction = beam.pair.direction;
    const Vec s = beam_.middle_force(direction, moved(closed, beam.a), moved(closed, beam.b));
    Vec t{};
    if (beam.is_inside()) {
      t = beam_.middle_force(direction, open[at(beam.a)], open[at(beam.b)]);
    }
    change.gap += energy_of(base::sum_of<double>(s, -1, t), stiffness_);
    change.norm += energy_of(t, stiffness_);
    Vec force = beam_.middle_force(direction, u[at(beam.pair.a)], u[at(beam.pair.b)]);
    base::add_times(force, 0.5, s);
    base::add_times(force, 0.5, t);
    change.ratio =
        std::max(change.ratio, model::load_ratio(robot_.connector(beam.pair), force).ratio);
  }
  add_feet(found, open, closed, change);
  return change;
}

void PatchBound::add_feet(const Case& found, const Vecs& open, const Vecs& closed,
                          Change& change) const {
  for (const PatchRegion::Foot& foot : found.region.feet) {
    const model::Facet& facet = robot_.facets()[foot.facet];
    const Vec s = beam_.middle_force(facet.direction, closed[at(foot.row)], {});
    const Vec t = found.hub == PatchRegion::kNone
                      ? beam_.middle_force(facet.direction, open[at(foot.row)], {})
                      : Vec{};
    change.gap += energy_of(base::sum_of<double>(s, -1, t), stiffness_);
    change.norm += energy_of(t, stiffness_);
    Vec force =
        beam_.middle_force(facet.direction, solved_.equilibrium.displacement[at(facet.module)], {});
    base::add_times(force, 0.5, s);
    base::add_times(force, 0.5, t);
    change.room = std::min(change.room, slack(facet, force));
  }
}

/// What comes upon the foot where a path ends.
void PatchBound::add_end(std::size_t module, const Vec& at_node, Path& path) const {
  const std::size_t facet = first_facet_[module];
  if (facet == first_facet_[module + 1]) {
    return;  // It is fixed.
  }
  const Vec more =
      force_in_middle(beam_, robot_.facets()[facet].direction, at_node, robot_.material().pitch_mm);
  path.energy += energy_of(more, stiffness_);
  const double b = robot_.foot_half_width_mm();
  for (const std::size_t axis : {3U, 4U}) {
    const double per_norm = std::sqrt(stiffness_[axis] + stiffness_[2] * b * b);
    path.need = std::max(path.need, (std::abs(more[2]) * b + std::abs(more[axis])) / 2 / per_norm);
  }
}

std::optional<PatchBound::Path> PatchBound::path_of(const LostPart& part, std::size_t hub) const {
  Path path;
  if (!part.module) {
    return path;
  }
  const Vec start = node_place(robot_, *part.module);
  Vec load{};
  base::add_times(load, -1, robot_.loads()[*part.module]);
  std::size_t module = hub;
  const auto here = [&] {
    return force_at(load, base::sum_of<double>(node_place(robot_, module), -1, start));
  };
  while (ground_hops_[module] > 0) {
    const std::size_t next = at(to_ground_[module]);
    const auto& around = robot_.connected()[module];
    const auto direction = static_cast<int>(
        std::ranges::find(around, static_cast<std::int32_t>(next)) - around.begin());
    const Vec force = force_in_middle(beam_, static_cast<Direction>(direction), here(),
                                      robot_.material().pitch_mm);
    path.energy += energy_of(force, stiffness_);
    for (const double sign : {0.5, -0.5}) {
      Vec half{};
      base::add_times(half, sign, force);
      path.ratio = std::max(path.ratio, connection_ratio(robot_, module, next, direction, half));
    }
    module = next;
  }
  add_end(module, here(), path);
  return path;
}

/// Says it as LoopBound does; where a module is lost, its share of what the others' masses have
/// moved is, too.
bool PatchBound::stays_over_polygon(const LostPart& part, double norm, double units) const {
  if (!limits_.has_polygon) {
    return true;
  }
  const bool is_smaller = part.module || !part.change.lost_facets.empty();
  const auto margin =
      is_smaller ? (shrinking_ ? shrinking_->margin_mm_without(part.module, part.change.lost_facets)
                               : std::nullopt)
                 : solved_.simplified.margin_mm;
  double own = 0;
  double mass_kg = limits_.mass_kg;
  if (part.module) {
    const Vec& u = solved_.equilibrium.displacement[*part.module];
    own = robot_.mass(*part.module) * std::hypot(u[0], u[1]);
    mass_kg -= robot_.mass(*part.module);
  }
  const double sway = std::hypot(limits_.sway[0], limits_.sway[1]);
  const double shift = (std::hypot(moved_[0], moved_[1]) + 2 * own +
                        sway * (limits_.error + norm * std::sqrt(1 + units))) /
                       mass_kg;
  return margin && shift < *margin;
}

std::optional<double> PatchBound::without(const LostPart& part, const Case& given) const {
  const Case* const found = &given;
  const auto factors = factors_of(*found);
  if (!factors->open || !std::isfinite(factors->units)) {
    return std::nullopt;
  }
  const auto open = open_answer(*found, *factors, found->loads);
  const auto path = found->hub_module ? path_of(part, *found->hub_module) : std::optional(Path{});
  if (!open || !path) {
    return std::nullopt;
  }
  Vecs closed = found->loads;
  if (found->hub != PatchRegion::kNone) {  // What the hub takes is balanced, too.
    base::add_times(closed[at(found->hub)], -1,
                    unbalanced(*found, *open, found->loads)[at(found->hub)]);
  }
  factors->closed->solve(closed);
  const Change change = change_of(*found, *open, closed);
  const double doubt = limits_.error * std::sqrt(factors->units);
  const double rounding = std::sqrt(kPatchRounding * change.norm);
  const double weight = std::sqrt(path->energy);
  const double off = (std::sqrt(change.gap) + weight) / 2 + doubt + rounding;
  const double high = solved_.load_ratio_max ? std::max(0.0, solved_.load_ratio_range.high) : 0.0;
  const double ratio = std::max(high, change.ratio + limits_.ratio_per_norm * limits_.error) +
                       path->ratio + limits_.ratio_per_norm * off;
  const double norm = std::sqrt(change.norm) + weight + doubt + rounding;
  const bool is_certain = ratio < kPatchRatioMax &&
                          off + path->need < std::min(limits_.room, change.room) &&
                          stays_over_polygon(part, norm, factors->units);
  return is_certain ? std::optional(ratio) : std::nullopt;
}

namespace {

bool is_known_to_patches(const LostPart& part) {
  return !part.is_apart && !part.has_fixed && part.fallen_count == 0 && part.body.empty();
}

}  // namespace

std::optional<double> PatchBound::without(const LostPart& part, int hops) const {
  for (const bool is_by_hub : {true, false}) {
    const auto found = is_known_to_patches(part) ? case_of(part, hops, is_by_hub) : std::nullopt;
    if (const auto bound = found ? without(part, *found) : std::nullopt) {
      return bound;
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> PatchBound::pattern(const LostPart& part, int hops) const {
  const auto region = is_known_to_patches(part)
                          ? region_around(robot_, part, first_facet_, hops, kPatchCountMax)
                          : std::nullopt;
  return region ? std::optional(std::hash<std::string>{}(region->key(robot_))) : std::nullopt;
}

std::size_t PatchBound::pattern_count_max(int hops) const {
  constexpr std::array<std::size_t, kHops.size()> kModulesPerPattern = {50, 100, 200};
  return robot_.modules().size() / kModulesPerPattern.at(at(hops - kHops.front()));
}

std::size_t PatchBound::sharing_min(int hops) {
  constexpr std::array<std::size_t, kHops.size()> kSharing = {1, 4, 8};
  return kSharing.at(at(hops - kHops.front()));
}

}  // namespace holdfast::plan
