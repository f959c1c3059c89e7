// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/assessment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "connection_law.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/mechanics/support_corners.hpp"
#include "several_solutions.hpp"

namespace holdfast::verdict {
namespace {

using mechanics::ContactLaw;
using solver::Equilibrium;
using solver::Outcome;

/// Sec. III-C: merges what every module contributes; the order does not matter.
ModelStability model_stability(const model::Robot& robot, const Equilibrium& equilibrium) {
  if (equilibrium.outcome != Outcome::kSettled) {
    return {};
  }
  mechanics::SupportCorners corners;
  if (robot.fixed_count() > 0) {
    corners = mechanics::fixed_support();
  }
  for (std::size_t i = 0; i < robot.facets().size() && !corners.stable; ++i) {
    const model::Module& module = robot.modules()[base::at(robot.facets()[i].module)];
    corners =
        mechanics::merge(corners, mechanics::support_corners(module.cell, equilibrium.contact[i]));
  }
  return {.is_stable = corners.stable, .is_settled = true};
}

/// Unlike with std::max, a NaN on either side wins: what is not known must not hide.
double max_or_nan(double a, double b) { return std::isnan(a) || a > b ? a : b; }

bool is_nan(const LoadRange& range) { return std::isnan(range.low) || std::isnan(range.high); }

/// What some connections in a row say together.
struct Loads {
  LoadRange range = {.low = -std::numeric_limits<double>::infinity(),
                     .high = -std::numeric_limits<double>::infinity()};
  double ratio_max = -std::numeric_limits<double>::infinity();
  double change = 0;  ///< The most by which the two answers differ, of any connection.
  std::size_t worst = 0;
  std::vector<std::size_t> broken;

  void add(std::size_t connection, double ratio, double other_ratio) {
    const double low = ratio < other_ratio ? ratio : other_ratio;
    const double high = ratio < other_ratio ? other_ratio : ratio;
    range = {.low = max_or_nan(range.low, low), .high = max_or_nan(range.high, high)};
    change = high - low > change ? high - low : change;
    if (ratio > ratio_max) {
      ratio_max = ratio;
      worst = connection;
    }
    if (breaks(ratio)) {
      broken.push_back(connection);
    }
  }

  void add(const Loads& next) {
    range = {.low = max_or_nan(range.low, next.range.low),
             .high = max_or_nan(range.high, next.range.high)};
    change = std::max(change, next.change);
    if (next.ratio_max > ratio_max) {
      ratio_max = next.ratio_max;
      worst = next.worst;
    }
    broken.insert(broken.end(), next.broken.begin(), next.broken.end());
  }
};

ConnectionResult connection_result(const model::Robot& robot, const ConnectionLaw& law,
                                   const Equilibrium& equilibrium, const model::Connection& pair) {
  if (!equilibrium.displacement_low.empty()) {
    return law.result(
        relative_motion(robot, pair, equilibrium.displacement, equilibrium.displacement_low),
        base::Vec6<double>{});
  }
  return law.result(equilibrium.displacement[static_cast<std::size_t>(pair.a)],
                    equilibrium.displacement[static_cast<std::size_t>(pair.b)]);
}

/// Every connection's result, and what they say together.
Loads add_up(const model::Robot& robot, int thread_count, Assessment& assessment) {
  // Of a connection the second module lies in a positive direction.
  const ConnectionLaw laws[] = {{robot.material(), base::Direction::kPlusX},
                                {robot.material(), base::Direction::kPlusY},
                                {robot.material(), base::Direction::kPlusZ}};
  const auto connections = robot.connections();
  const Equilibrium& equilibrium = assessment.equilibrium;
  const bool has_alternative =
      equilibrium.displacement_low.empty() || equilibrium.open_but_held_count > 0;
  assessment.connections.resize(connections.size());
  host::Team team(thread_count, connections.size());
  std::vector<Loads> parts;
  team.map(connections.size(), parts, [&](std::size_t begin, std::size_t end) {
    Loads part;
    for (std::size_t i = begin; i < end; ++i) {
      const model::Connection& pair = connections[i];
      const ConnectionLaw& law = laws[base::index(pair.direction) / 2];
      const auto a = static_cast<std::size_t>(pair.a);
      const auto b = static_cast<std::size_t>(pair.b);
      assessment.connections[i] = connection_result(robot, law, equilibrium, pair);
      const double ratio = assessment.connections[i].load_ratio;
      part.add(i, ratio,
               has_alternative
                   ? law.load_ratio(equilibrium.alternative[a], equilibrium.alternative[b])
                   : ratio);
    }
    return part;
  });
  Loads all;
  for (const Loads& part : parts) {
    all.add(part);
  }
  return all;
}

/// Two answers of multigrid differ by less than the error of the better one, once in a while, and
/// the error's energy is estimated too low. So of any connection the margin takes the largest
/// difference so many times, or what the energy so many times could do to a load ratio, whichever
/// is less; and never less than what is promised (docs/solver.md).
constexpr double kMultigridFactor = 10;
constexpr double kEnergyFactor = 3;

/// Refinements in double that find nothing but rounding differ by less than their error now and
/// then.
constexpr double kDirectFactor = 10;

double tolerance_share(const solver::EquilibriumOptions& options) {
  return options.tolerance / solver::EquilibriumOptions{}.tolerance;
}

/// How far the largest load ratio may be from the truth, if multigrid's tolerance is so many times
/// the usual one.
double error_margin(const model::Robot& robot, const Equilibrium& equilibrium,
                    double tolerance_share, const Loads& loads) {
  const double scale = std::max(1.0, loads.ratio_max);
  double margin = kRounding * scale;
  if (equilibrium.law == ContactLaw::kUnilateral && equilibrium.gamma > 0) {
    margin += kWeakSprings * equilibrium.gamma * scale;
  }
  if (equilibrium.open_but_held_count > 0) {
    return margin;  // The answers differ by more than an error.
  }
  if (equilibrium.method == solver::Method::kMultigrid) {
    const double bound = kEnergyFactor * model::load_ratio_per_energy_norm(robot.material()) *
                         equilibrium.energy_error;
    return margin + std::max(kMultigridError * tolerance_share * scale,
                             std::min(kMultigridFactor * loads.change, bound));
  }
  return margin + kDirectFactor * loads.change;
}

/// Nothing is said of a load below its own uncertainty: then it may as well be compression. Between
/// the answers of ambiguous feet, which lie far apart, each is as good as the other.
bool is_pulled_apart(double ratio_max, const Assessment& assessment) {
  const LoadRange& range = assessment.load_ratio_range;
  const bool is_known = breaks(ratio_max) || assessment.equilibrium.open_but_held_count > 0 ||
                        ratio_max > range.high - range.low;
  return ratio_max >= kLoadRatioTie && is_known;
}

/// Sec. III-D for every connection.
void assess_connections(const model::Robot& robot, const solver::EquilibriumOptions& options,
                        Assessment& assessment) {
  if (robot.connections().empty()) {
    return;
  }
  Loads loads = add_up(robot, options.thread_count, assessment);
  assessment.load_ratio_change = loads.change;
  const double margin =
      error_margin(robot, assessment.equilibrium, tolerance_share(options), loads);
  assessment.load_ratio_range = {.low = loads.range.low - margin,
                                 .high = loads.range.high + margin};
  assessment.broken = std::move(loads.broken);
  std::ranges::stable_sort(assessment.broken, std::greater<>(),
                           [&](std::size_t i) { return assessment.connections[i].load_ratio; });
  if (is_nan(loads.range)) {
    return;
  }
  assessment.load_ratio_max = loads.ratio_max;
  if (is_pulled_apart(loads.ratio_max, assessment)) {
    assessment.worst = loads.worst;
    assessment.weight_factor = 1 / loads.ratio_max;
  }
}

/// Weak springs beside the unilateral contact of a stable robot: they change no load ratio by more
/// than about 1e-8, and keep the matrix regular on the way to the answer.
constexpr double kStableGammas[] = {1e-9};

/// Multigrid tries only this one: weaker springs escape its single precision, below its own error.
constexpr double kStableGammasMultigrid[] = {1e-6};

/// A toppling robot hangs on its weak springs, and bends elastically while it does: if they are
/// stiff, three corners may still touch and look like a hold. The weaker they are, the more the
/// tilt outweighs the bending; the second value serves one robot in ten thousand. Much weaker ones
/// drown the contact states in rounding.
constexpr double kTopplingGammas[] = {1e-6, 1e-7};

/// From here on a robot that topples is told from the rigid body alone, which is certain: its
/// equilibrium is that of the weak springs it would hang on, a large and almost singular problem.
constexpr std::size_t kTopplingCountMax = 1000;

/// A verdict that hangs on multigrid's error is sought once more with so much less of it.
constexpr double kFinerTolerance = 1e-6;

/// Then the direct solver is asked first where no more blocks than this fill in per module: a solid
/// cube of 17, 4,913 modules, has 60.
constexpr std::size_t kPreciseFillMax = 100;

/// Whether the model's stability is the rigid body's. A margin of zero is unstable by decision, not
/// by mechanics: no model need agree with it.
bool agrees(const Assessment& assessment) {
  return assessment.model.is_settled && (assessment.model.is_stable == assessment.is_stable ||
                                         assessment.simplified.margin_mm == 0);
}

ContactModel contact_model(const model::Robot& robot, ContactLaw law) {
  if (robot.ground_count() == 0) {
    return ContactModel::kNone;
  }
  return law == ContactLaw::kUnilateral ? ContactModel::kUnilateral : ContactModel::kRegularised;
}

std::span<const double> weak_springs(solver::EquilibriumSolver& solver, bool is_stable) {
  if (!is_stable) {
    return kTopplingGammas;
  }
  return solver.prepare(ContactLaw::kUnilateral) == solver::Method::kMultigrid
             ? std::span<const double>(kStableGammasMultigrid)
             : kStableGammas;
}

/// The paper's contact law first; the exact one where it has no answer or one that contradicts the
/// rigid body, which is certain on flat ground, and beside it where the paper's has several.
void find_equilibrium(const model::Robot& robot, const solver::EquilibriumOptions& options,
                      Assessment& assessment) {
  if (!assessment.is_stable && (robot.modules().size() > kTopplingCountMax ||
                                options.method == solver::Method::kMultigrid)) {
    assessment.equilibrium.outcome = Outcome::kNotSought;
    return;
  }
  solver::EquilibriumSolver solver(robot, options);
  assessment.equilibrium =
      solver.solve({.law = ContactLaw::kRegularised, .gamma = robot.material().contact_gamma});
  assessment.model = model_stability(robot, assessment.equilibrium);
  assessment.contact_model = contact_model(robot, ContactLaw::kRegularised);
  if (assessment.equilibrium.outcome == Outcome::kTooLarge || robot.ground_count() == 0) {
    return;
  }
  if (options.is_bonded) {
    assessment.contact_model = ContactModel::kBonded;
    return;
  }
  const bool is_settled = agrees(assessment);
  if (is_settled && !assessment.is_stable) {
    return;
  }
  if (is_settled) {
    solver.seek_others(assessment.equilibrium);
    if (assessment.equilibrium.others.empty()) {
      return;
    }
  }
  const std::span<const double> gammas = weak_springs(solver, assessment.is_stable);
  if (is_settled) {
    compare_solutions(robot, solver, gammas.front(), tolerance_share(options), assessment);
    return;
  }
  for (const double gamma : gammas) {
    if (agrees(assessment)) {
      return;
    }
    Equilibrium exact = solver.solve({.law = ContactLaw::kUnilateral, .gamma = gamma});
    exact.begin_with(assessment.equilibrium);
    assessment.equilibrium = std::move(exact);
    assessment.model = model_stability(robot, assessment.equilibrium);
    assessment.contact_model = ContactModel::kUnilateral;
  }
}

Reason toppling_reason(const RigidBody& body) {
  const auto& [a, b] = *body.edge;
  if (*body.margin_mm == 0) {
    return {.code = ReasonCode::kNothingToSpare, .numbers = {a.x, a.y, b.x, b.y}};
  }
  return {.code = ReasonCode::kTopples, .numbers = {a.x, a.y, b.x, b.y, -*body.margin_mm}};
}

/// Why the loads of a stable robot are not known; none if they are.
std::optional<Reason> find_obstacle(const model::Robot& robot, const Equilibrium& equilibrium) {
  switch (equilibrium.outcome) {
    case Outcome::kSettled:
      return std::nullopt;
    case Outcome::kTooLarge:
      return Reason{.code = ReasonCode::kTooManyModules,
                    .numbers = {static_cast<double>(robot.modules().size())}};
    case Outcome::kTooSlow:
      return Reason{.code = ReasonCode::kNoDigitsLeft};
    case Outcome::kSingular:
      return Reason{.code = ReasonCode::kSingularStiffness,
                    .numbers = {static_cast<double>(equilibrium.steps)}};
    default:
      return Reason{.code = ReasonCode::kNoEquilibrium,
                    .numbers = {static_cast<double>(equilibrium.steps)}};
  }
}

/// Why the loads do not say whether anything breaks; none if they do.
std::optional<Reason> find_doubt(const Assessment& assessment) {
  const LoadRange& range = assessment.load_ratio_range;
  const bool is_broken = breaks(range.low);
  if (is_nan(range)) {
    return Reason{.code = ReasonCode::kLoadNotANumber};
  }
  if (!std::isfinite(range.low) || !std::isfinite(range.high) || breaks(range.high) != is_broken) {
    return Reason{.code = ReasonCode::kLimitInRange, .numbers = {range.low, range.high}};
  }
  if (assessment.several && !do_agree(*assessment.several, is_broken)) {
    return reason_of(ReasonCode::kSolutionsDisagree, *assessment.several);
  }
  return std::nullopt;
}

/// Why a robot is safe in which nothing breaks.
Reason holding_reason(const Assessment& assessment) {
  if (assessment.connections.empty()) {
    return {.code = ReasonCode::kSingleModule};
  }
  if (assessment.worst) {
    return {.code = ReasonCode::kHolds,
            .numbers = {static_cast<double>(*assessment.worst), *assessment.load_ratio_max}};
  }
  const double bound = assessment.load_ratio_range.high;
  return bound < kLoadRatioTie ? Reason{.code = ReasonCode::kNoTension}
                               : Reason{.code = ReasonCode::kNoKnownTension, .numbers = {bound}};
}

Reason breaking_reason(const Assessment& assessment) {
  return {.code = ReasonCode::kConnectionsBreak,
          .numbers = {static_cast<double>(assessment.broken.size()),
                      static_cast<double>(assessment.connections.size()),
                      static_cast<double>(*assessment.worst), *assessment.load_ratio_max}};
}

void decide_stable(const model::Robot& robot, Assessment& assessment) {
  auto obstacle = find_obstacle(robot, assessment.equilibrium);
  if (!obstacle) {
    obstacle = find_doubt(assessment);
  }
  if (obstacle) {
    assessment.reasons.push_back(*std::move(obstacle));
  } else if (breaks(assessment.load_ratio_range.low)) {
    assessment.verdict = Verdict::kOverload;
    assessment.reasons.push_back(breaking_reason(assessment));
  } else {
    assessment.verdict = Verdict::kSafe;
    assessment.reasons.push_back(holding_reason(assessment));
  }
}

void add_contact_remarks(Assessment& assessment) {
  std::vector<Reason>& reasons = assessment.reasons;
  if (assessment.contact_model == ContactModel::kUnilateral) {
    reasons.push_back({.code = ReasonCode::kUnilateralContact});
  }
  if (assessment.several && assessment.verdict != Verdict::kUndecided) {
    reasons.push_back(reason_of(ReasonCode::kSolutionsAgree, *assessment.several));
  }
  if (assessment.equilibrium.open_but_held_count > 0) {
    reasons.push_back(
        {.code = ReasonCode::kAmbiguousFeet,
         .numbers = {static_cast<double>(assessment.equilibrium.open_but_held_count),
                     assessment.load_ratio_range.low, assessment.load_ratio_range.high}});
  }
  if (assessment.contact_model == ContactModel::kBonded) {
    reasons.push_back({.code = ReasonCode::kBonded});
    return;
  }
  if (assessment.model.is_settled && assessment.model.is_stable != assessment.is_stable) {
    reasons.push_back(
        {.code = ReasonCode::kModelDisagrees, .numbers = {assessment.model.is_stable ? 1.0 : 0.0}});
  }
}

Assessment begin(const model::Robot& robot) {
  Assessment assessment;
  assessment.simplified = assess_rigid_body(robot);
  assessment.is_stable = assessment.simplified.is_stable;
  return assessment;
}

/// Loads, verdict and reasons, once there is an equilibrium.
Assessment conclude(const model::Robot& robot, Assessment assessment,
                    const solver::EquilibriumOptions& options) {
  if (assessment.equilibrium.outcome == Outcome::kSettled) {
    assess_connections(robot, options, assessment);
  }
  if (assessment.is_stable) {
    decide_stable(robot, assessment);
  } else {
    assessment.verdict = Verdict::kUnstable;
    assessment.reasons.push_back(toppling_reason(assessment.simplified));
  }
  add_contact_remarks(assessment);
  return assessment;
}

Assessment assess_once(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  Assessment assessment = begin(robot);
  assessment.is_stable = assessment.is_stable || options.is_bonded;
  find_equilibrium(robot, options, assessment);
  return conclude(robot, std::move(assessment), options);
}

/// Whether an error no larger than what the range allows for would decide.
bool is_near_limit(const Assessment& assessment) {
  return assessment.is_stable && assessment.equilibrium.outcome == Outcome::kSettled &&
         assessment.equilibrium.open_but_held_count == 0 &&
         (breaks(assessment.load_ratio_range.low) != breaks(assessment.load_ratio_range.high) ||
          (assessment.several &&
           !do_agree(*assessment.several, breaks(assessment.load_ratio_range.low))));
}

/// Where the verdict hangs on the error: the direct solver with all digits, or where that does not
/// fit multigrid with more of them.
std::vector<solver::EquilibriumOptions> finer_options(const solver::EquilibriumOptions& options) {
  std::vector<solver::EquilibriumOptions> list;
  if (options.method != solver::Method::kMultigrid) {
    solver::EquilibriumOptions& direct = list.emplace_back(options);
    direct.method = solver::Method::kDirect;
    direct.is_precise = true;
    direct.fill_max = kPreciseFillMax;
  }
  if (options.method != solver::Method::kDirect) {
    solver::EquilibriumOptions& multigrid = list.emplace_back(options);
    multigrid.method = solver::Method::kMultigrid;
    multigrid.precision = solver::Precision::kDouble;
    multigrid.tolerance *= kFinerTolerance;
  }
  return list;
}

}  // namespace

Assessment assess(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  Assessment assessment = assess_once(robot, options);
  if (!is_near_limit(assessment)) {
    return assessment;
  }
  for (const solver::EquilibriumOptions& finer : finer_options(options)) {
    Assessment next = assess_once(robot, finer);
    // Solutions that were found once are there, whether or not they are found again.
    const bool is_one_lost = assessment.several && !next.several;
    if (next.equilibrium.outcome == Outcome::kSettled && !is_one_lost) {
      return next;
    }
  }
  return assessment;
}

Assessment assess_equilibrium(const model::Robot& robot, Equilibrium equilibrium,
                              int thread_count) {
  Assessment assessment = begin(robot);
  assessment.equilibrium = std::move(equilibrium);
  assessment.model = model_stability(robot, assessment.equilibrium);
  assessment.contact_model = contact_model(robot, assessment.equilibrium.law);
  return conclude(robot, std::move(assessment), {.thread_count = thread_count});
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSafe:
      return "safe";
    case Verdict::kOverload:
      return "overload";
    case Verdict::kUnstable:
      return "unstable";
    case Verdict::kUndecided:
      break;
  }
  return "undecided";
}

const char* name(ContactModel model) {
  switch (model) {
    case ContactModel::kRegularised:
      return "regularised";
    case ContactModel::kUnilateral:
      return "unilateral";
    case ContactModel::kBonded:
      return "bonded";
    case ContactModel::kNone:
      break;
  }
  return "none";
}

}  // namespace holdfast::verdict
