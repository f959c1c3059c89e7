// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "connection_assessment.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "holdfast/host/free_memory.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/verdict/connection_law.hpp"

namespace holdfast::verdict {
namespace {

using mechanics::ContactLaw;
using solver::Equilibrium;

/// The factor for weak springs that are not taken back from the unilateral contact of a stable
/// robot: they may move load ratios by so many times their share of the contact's stiffness,
/// besides what their energy may do. In a robot of 4,327 modules with long thin limbs springs of
/// 1e-9 moved the largest load ratio by 1.4e-4, and of 1e-6 by 4 %, so this alone is no bound.
constexpr double kWeakSprings = 1e3;

/// The error of multigrid, as it promises (docs/solver.md).
constexpr double kMultigridError = 1e-4;

/// The larger number; unlike with std::max, a NaN on either side wins, so that nothing unknown is
/// hidden.
double max_or_nan(double a, double b) { return std::isnan(a) || a > b ? a : b; }

bool is_nan(const LoadRange& range) { return std::isnan(range.low) || std::isnan(range.high); }

/// The sums of what some connections say.
struct Loads {
  LoadRange range = {.low = -std::numeric_limits<double>::infinity(),
                     .high = -std::numeric_limits<double>::infinity()};
  double ratio_max = -std::numeric_limits<double>::infinity();
  double other_max = -std::numeric_limits<double>::infinity();  ///< Of the second answer.
  double change = 0;  ///< The most by which the two answers differ, of any connection.
  std::size_t worst = 0;

  void add(std::size_t connection, double ratio, double other_ratio) {
    const double low = ratio < other_ratio ? ratio : other_ratio;
    const double high = ratio < other_ratio ? other_ratio : ratio;
    range = {.low = max_or_nan(range.low, low), .high = max_or_nan(range.high, high)};
    change = high - low > change ? high - low : change;
    other_max = other_ratio > other_max ? other_ratio : other_max;
    if (ratio > ratio_max) {
      ratio_max = ratio;
      worst = connection;
    }
  }

  /// Returns whether the worst is one of the next.
  bool add(const Loads& next) {
    range = {.low = max_or_nan(range.low, next.range.low),
             .high = max_or_nan(range.high, next.range.high)};
    change = std::max(change, next.change);
    other_max = std::max(other_max, next.other_max);
    const bool is_worse = next.ratio_max > ratio_max;
    worst = is_worse ? next.worst : worst;
    ratio_max = is_worse ? next.ratio_max : ratio_max;
    return is_worse;
  }
};

/// Whether the second answer is for the range alone, so that its memory may go before results take
/// theirs.
bool is_alternative_spent(const Equilibrium& equilibrium) {
  return equilibrium.method == solver::Method::kMultigrid && equilibrium.displacement_low.empty() &&
         equilibrium.open_but_held_count == 0;
}

/// Adds up what all connections say, and which break; keeps the results of each as well, if the
/// second answer is to stay. If that has gone before, nothing is known of how the two differ.
Loads add_up(const model::Robot& robot, host::Team& team, Assessment& assessment) {
  const ConnectionLaws laws(robot);
  const auto connections = robot.connections();
  const Equilibrium& equilibrium = assessment.equilibrium;
  const bool has_alternative =
      !equilibrium.alternative.empty() &&
      (equilibrium.displacement_low.empty() || equilibrium.open_but_held_count > 0);
  const bool is_kept = !is_alternative_spent(equilibrium);
  assessment.connections.resize(is_kept ? connections.size() : 0);

  struct Chunk {
    Loads loads;
    std::vector<std::size_t> broken;
  };

  std::vector<Chunk> chunks;
  team.map(connections.size(), chunks, [&](std::size_t begin, std::size_t end) {
    Chunk chunk;
    auto connection = connections.from(begin);
    for (std::size_t i = begin; i < end; ++i, ++connection) {
      const model::Connection pair = *connection;
      if (is_kept) {
        assessment.connections[i] =
            laws.result(pair, equilibrium.displacement, equilibrium.displacement_low);
      }
      const double ratio = is_kept ? assessment.connections[i].load_ratio
                                   : laws.load_ratio(pair, equilibrium.displacement, {});
      const double other_ratio =
          has_alternative ? laws.load_ratio(pair, equilibrium.alternative[base::at(pair.a)],
                                            equilibrium.alternative[base::at(pair.b)])
                          : ratio;
      chunk.loads.add(i, ratio, other_ratio);
      if (breaks(ratio)) {
        chunk.broken.push_back(i);
      }
    }
    return chunk;
  });
  Loads all;
  for (const Chunk& chunk : chunks) {
    all.add(chunk.loads);
    assessment.broken.insert(assessment.broken.end(), chunk.broken.begin(), chunk.broken.end());
  }
  if (!is_kept && !has_alternative) {
    all.change = std::numeric_limits<double>::infinity();
  }
  return all;
}

/// Every connection's result.
void add_results(const model::Robot& robot, host::Team& team, Assessment& assessment) {
  const ConnectionLaws laws(robot);
  const auto connections = robot.connections();
  const Equilibrium& equilibrium = assessment.equilibrium;
  assessment.connections.resize(connections.size());
  team.share(0, connections.size(), [&](std::size_t begin, std::size_t end) {
    auto connection = connections.from(begin);
    for (std::size_t i = begin; i < end; ++i, ++connection) {
      assessment.connections[i] =
          laws.result(*connection, equilibrium.displacement, equilibrium.displacement_low);
    }
  });
}

/// The loads of one rank's connections, for all others.
struct RankLoads {
  Loads loads;
  std::array<base::Cell, 2> worst_ends = {};
  std::size_t connection_count = 0;
  std::size_t broken_count = 0;
};

/// Takes in what all ranks' connections say together; which are broken stays each rank's own.
WholeLoads add_ranks(const model::Robot& robot, std::size_t broken_count, Loads& loads) {
  const std::size_t count = robot.connections().size();
  const RankLoads mine = {
      .loads = loads,
      .worst_ends = count > 0 ? model::ends(robot, loads.worst) : std::array<base::Cell, 2>{},
      .connection_count = count,
      .broken_count = broken_count};
  WholeLoads whole;
  loads = {};
  for (const RankLoads& one : host::gather(robot.ranks(), std::span<const RankLoads>(&mine, 1))) {
    if (loads.add(one.loads)) {
      whole.worst = one.worst_ends;
    }
    whole.connection_count += one.connection_count;
    whole.broken_count += one.broken_count;
  }
  return whole;
}

/// The factor of multigrid's margin. Two answers of multigrid differ now and then by less than the
/// error of the better one, and the error's energy is estimated too low. A connection's margin is
/// therefore the largest difference times this factor, or what this factor times the energy could
/// do to a load ratio, whichever is less; and never less than what is promised (docs/solver.md).
constexpr double kMultigridFactor = 10;

/// The additional factor for a verdict that depends on the error and is sought with more digits.
/// Rounding may leave fewer digits than the two answers have in common: in a tower of 111,111
/// levels they differed by a thirtieth of the error.
constexpr double kFinerFactor = 10;

/// Refinements in double that find nothing but rounding differ by less than their error now and
/// then.
constexpr double kDirectFactor = 10;

/// The ratio of a beam's largest stiffness to its least, all as forces by millimetres at its ends.
double stiffness_spread(const model::Robot& robot) {
  const model::LatticeBeam<double> beams(model::beam_section(robot.material()), robot.lattice());
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (const base::Direction direction : base::facet_directions(robot.lattice())) {
    const auto& k = beams.stiffness(direction);
    const double square = beams.length(direction) * beams.length(direction);
    const auto [low, high] = std::minmax(
        {k.shear_x, k.shear_y, k.axial, k.bend_x / square, k.bend_y / square, k.twist / square});
    least = std::min(least, low);
    most = std::max(most, high);
  }
  return most / least;
}

/// The distance by which the largest load ratio may be off.
double error_margin(const model::Robot& robot, const solver::EquilibriumOptions& options,
                    const Equilibrium& equilibrium, const Loads& loads) {
  const double scale = std::max(1.0, loads.ratio_max);
  const bool is_multigrid = equilibrium.method == solver::Method::kMultigrid;
  const double least = is_multigrid ? multigrid_error(robot, options) : 0;
  const double bound =
      kEnergyFactor * model::load_ratio_per_energy_norm(robot) * equilibrium.energy_error;
  const double margin = kRounding * scale + weak_spring_error(robot, equilibrium, scale);
  if (equilibrium.open_but_held_count > 0) {
    return margin + least * scale;  // The answers differ by more than an error.
  }
  if (is_multigrid) {
    const bool is_finer = options.tolerance < solver::EquilibriumOptions{}.tolerance;
    const double factor = kMultigridFactor * (is_finer ? kFinerFactor : 1);
    return margin + std::max(least * scale, std::min(factor * loads.change, bound));
  }
  return margin + kDirectFactor * loads.change;
}

/// The range between the largest load ratios of two answers.
LoadRange between_answers(const Loads& loads) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  return is_nan(loads.range) ? LoadRange{.low = kNan, .high = kNan}
                             : LoadRange{.low = std::min(loads.ratio_max, loads.other_max),
                                         .high = std::max(loads.ratio_max, loads.other_max)};
}

/// Robots of so many modules free the solver's memory before their results, one block that fits
/// into no hole, are allocated: a ball of 990,000 modules takes 380 MB instead of 500.
constexpr std::size_t kManyModules = 200'000;

/// Whether a load counts as tension. A load below its own uncertainty may as well be compression;
/// between the answers of ambiguous feet, which lie far apart, each is as good as the other.
bool is_pulled_apart(double ratio_max, const Assessment& assessment) {
  const LoadRange& range = assessment.load_ratio_range;
  const bool is_known = breaks(ratio_max) || assessment.equilibrium.open_but_held_count > 0 ||
                        ratio_max > range.high - range.low;
  return ratio_max >= kLoadRatioTie && is_known;
}

/// The gap that is widest for its limit, and the count of all ranks' gaps.
OpenGaps widest_of_all(host::Ranks& ranks, const OpenGaps& mine) {
  OpenGaps widest = mine;
  widest.count = 0;
  for (const OpenGaps& one : host::gather(ranks, std::span<const OpenGaps>(&mine, 1))) {
    const std::size_t count = widest.count + one.count;
    const bool is_wider =
        one.limit_mm > 0 &&
        (widest.limit_mm == 0 || one.gap_mm / one.limit_mm > widest.gap_mm / widest.limit_mm);
    widest = is_wider ? one : widest;
    widest.count = count;
  }
  return widest;
}

}  // namespace

/// Static condensation adds the flexibilities of stiff and soft ways to deform, and keeps the
/// digits of the largest: some ten roundings for each module on the way. A corkscrew of 130 modules
/// with a spread of 7e13 lost a quarter.
/// And however small the tolerance, rounding leaves more: 5e-8 in some of 200 random robots in
/// single precision.
double multigrid_error(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  constexpr double kRoundingCount = 10;
  constexpr double kLeastSingle = 1e-6;
  constexpr double kLeastDouble = 1e-9;
  const double least =
      options.precision == solver::Precision::kDouble ? kLeastDouble : kLeastSingle;
  const double tolerance_share = options.tolerance / solver::EquilibriumOptions{}.tolerance;
  return std::max({kMultigridError * tolerance_share, least,
                   kRoundingCount * std::numeric_limits<double>::epsilon() *
                       static_cast<double>(robot.modules().size()) * stiffness_spread(robot)});
}

double weak_spring_error(const model::Robot& robot, const Equilibrium& equilibrium, double scale) {
  const double gamma = std::max(equilibrium.gamma, equilibrium.free_gamma);
  if (equilibrium.law != ContactLaw::kUnilateral || gamma == 0) {
    return 0;
  }
  const bool is_in_alternative = equilibrium.open_but_held_count == 0;
  const double energy = equilibrium.energy_error;
  return kWeakSprings * gamma * scale +
         (is_in_alternative && std::isfinite(energy)
              ? 0
              : kEnergyFactor * model::load_ratio_per_energy_norm(robot) * energy);
}

LoadRange assess_loads(const Situation& here, const solver::EquilibriumOptions& options,
                       Assessment& assessment) {
  if (!here.has_connections) {
    return {};
  }
  const model::Robot& robot = here.robot;
  host::Team team(options.thread_count, robot.connections().size());
  Loads loads = add_up(robot, team, assessment);
  if (is_alternative_spent(assessment.equilibrium)) {
    assessment.equilibrium.alternative = std::vector<base::Vec6<double>>();
  }
  if (robot.ranks().is_shared()) {
    assessment.whole = add_ranks(robot, assessment.broken.size(), loads);
  }
  assessment.load_ratio_change = loads.change;
  const double margin = error_margin(robot, options, assessment.equilibrium, loads);
  assessment.load_ratio_range = {.low = loads.range.low - margin,
                                 .high = loads.range.high + margin};
  if (!is_nan(loads.range)) {
    assessment.load_ratio_max = loads.ratio_max;
    if (is_pulled_apart(loads.ratio_max, assessment)) {
      assessment.worst = loads.worst;
      assessment.weight_factor = 1 / loads.ratio_max;
    }
  }
  return between_answers(loads);
}

/// Finds the load ratio of every connection (Sec. III-D).
void assess_connections(const model::Robot& robot, int thread_count, Assessment& assessment) {
  if (assessment.connections.empty() && !robot.connections().empty()) {
    if (robot.modules().size() >= kManyModules) {
      host::give_back_free_memory();
    }
    host::Team team(thread_count, robot.connections().size());
    add_results(robot, team, assessment);
  }
  std::ranges::stable_sort(assessment.broken, std::greater<>(),
                           [&](std::size_t i) { return assessment.connections[i].load_ratio; });
}

std::optional<OpenGaps> find_open_gaps(const model::Robot& robot, std::span<const double> gap_mm) {
  OpenGaps gaps;
  double share_max = 0;
  for (std::size_t i = 0; i < gap_mm.size(); ++i) {
    const double limit = robot.connector(robot.connections()[i]).gap_limit_mm;
    gaps.count += gap_mm[i] > limit ? 1 : 0;
    if (gap_mm[i] / limit > share_max) {
      share_max = gap_mm[i] / limit;
      gaps.worst = i;
      gaps.gap_mm = gap_mm[i];
      gaps.limit_mm = limit;
      gaps.ends = model::ends(robot, i);
    }
  }
  gaps = widest_of_all(robot.ranks(), gaps);
  return gaps.count > 0 ? std::optional(gaps) : std::nullopt;
}

std::optional<OpenGaps> find_open_gaps(const model::Robot& robot, const Equilibrium& equilibrium) {
  const bool is_limited = std::ranges::any_of(
      robot.connectors(), [](const auto& law) { return std::isfinite(law.gap_limit_mm); });
  if (!is_limited) {
    return std::nullopt;
  }
  const ConnectionLaws laws(robot);
  std::vector<double> gap_mm;
  gap_mm.reserve(robot.connections().size());
  for (const model::Connection& pair : robot.connections()) {
    gap_mm.push_back(laws.gap_mm(pair, equilibrium.displacement, equilibrium.displacement_low));
  }
  return find_open_gaps(robot, gap_mm);
}

}  // namespace holdfast::verdict
