// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/assessment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "holdfast/verdict/connection_law.hpp"
#include "holdfast/host/team.hpp"
#include "several_solutions.hpp"
#include "stability.hpp"

namespace holdfast::verdict {
namespace {

using mechanics::ContactLaw;
using solver::Equilibrium;
using solver::Outcome;

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

/// Every connection's result, and what they say together.
Loads add_up(const model::Robot& robot, int thread_count, Assessment& assessment) {
  const ConnectionLaws laws(robot);
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
      assessment.connections[i] =
          laws.result(pair, equilibrium.displacement, equilibrium.displacement_low);
      const double ratio = assessment.connections[i].load_ratio;
      part.add(i, ratio,
               has_alternative ? laws.load_ratio(pair, equilibrium.alternative[base::at(pair.a)],
                                                 equilibrium.alternative[base::at(pair.b)])
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
    const double bound =
        kEnergyFactor * model::load_ratio_per_energy_norm(robot) * equilibrium.energy_error;
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

std::optional<OpenGaps> find_open_gaps(const model::Robot& robot, const Equilibrium& equilibrium) {
  const bool is_limited = std::ranges::any_of(
      robot.connectors(), [](const auto& law) { return std::isfinite(law.gap_limit_mm); });
  if (!is_limited) {
    return std::nullopt;
  }
  const ConnectionLaws laws(robot);
  OpenGaps gaps;
  double share_max = 0;
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const model::Connection& pair = robot.connections()[i];
    const double limit = robot.connector(pair).gap_limit_mm;
    const double gap = laws.gap_mm(pair, equilibrium.displacement, equilibrium.displacement_low);
    gaps.count += gap > limit ? 1 : 0;
    if (gap / limit > share_max) {
      share_max = gap / limit;
      gaps.worst = i;
      gaps.gap_mm = gap;
      gaps.limit_mm = limit;
    }
  }
  return gaps.count > 0 ? std::optional(gaps) : std::nullopt;
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
  if (assessment.stability_rule == StabilityRule::kContactForces) {
    return assessment.model.is_settled;  // Each is an answer of its own.
  }
  return assessment.model.is_settled && (assessment.model.is_stable == assessment.is_stable ||
                                         assessment.simplified.margin_mm == 0);
}

ContactModel contact_model(const model::Robot& robot, ContactLaw law) {
  if (std::ranges::all_of(robot.facets(), &model::Facet::is_bonded)) {
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
  if (assessment.equilibrium.outcome == Outcome::kTooLarge ||
      assessment.contact_model == ContactModel::kNone) {
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
  if (assessment.stability_rule != StabilityRule::kContactForces && assessment.model.is_settled &&
      assessment.model.is_stable != assessment.is_stable) {
    reasons.push_back(
        {.code = ReasonCode::kModelDisagrees, .numbers = {assessment.model.is_stable ? 1.0 : 0.0}});
  }
}

/// Of the answers with supports anywhere neither is enough to be safe. Without equilibrium the
/// model has none.
void heed_model(const model::Robot& robot, Assessment& assessment) {
  if (!assessment.is_stable) {
    return;
  }
  const auto slip = assessment.equilibrium.outcome == Outcome::kSettled
                        ? find_slip(robot, assessment.equilibrium)
                        : std::nullopt;
  if (assessment.stability_rule == StabilityRule::kContactForces && assessment.model.is_settled &&
      !assessment.model.is_stable) {
    assessment.is_stable = false;
    assessment.verdict = Verdict::kUnstable;
    assessment.reasons.push_back({.code = ReasonCode::kModelFalls});
  } else if (slip) {
    const model::Facet& facet = robot.facets()[slip->facet];
    assessment.is_stable = false;
    assessment.reasons.push_back(
        {.code = ReasonCode::kMaySlip,
         .numbers = {static_cast<double>(facet.module), slip->ratio, *facet.touch.friction}});
  }
}

/// The verdict on a robot that the rigid body does not hold.
void decide_falling(Assessment& assessment) {
  using limit::RigidAnswer;
  const limit::RigidStability& rigid = assessment.rigid;
  assessment.verdict =
      rigid.answer == RigidAnswer::kUndecided ? Verdict::kUndecided : Verdict::kUnstable;
  if (assessment.simplified.edge && assessment.simplified.margin_mm) {
    assessment.reasons.push_back(toppling_reason(assessment.simplified));
  } else if (rigid.answer == RigidAnswer::kUndecided) {
    assessment.reasons.push_back({.code = ReasonCode::kRigidUndecided});
  } else if (rigid.answer == RigidAnswer::kNothingToSpare) {
    assessment.reasons.push_back({.code = ReasonCode::kBalances});
  } else {
    assessment.reasons.push_back(
        {.code = ReasonCode::kFalls,
         .quoted = rigid.motion ? limit::text(*rigid.motion) : std::string()});
  }
}

/// What is no reason for the verdict, but belongs to its loads.
void add_load_remarks(const model::Robot& robot, Assessment& assessment) {
  if (assessment.gaps) {
    assessment.reasons.push_back({.code = ReasonCode::kGapsOpen,
                                  .numbers = {static_cast<double>(assessment.gaps->count),
                                              static_cast<double>(assessment.gaps->worst),
                                              assessment.gaps->gap_mm, assessment.gaps->limit_mm}});
  }
  if (robot.has_payloads() && assessment.worst) {
    assessment.reasons.push_back({.code = ReasonCode::kLoadsTogether});
  }
}

/// Loads, verdict and reasons, once there is an equilibrium.
Assessment conclude(const model::Robot& robot, Assessment assessment,
                    const solver::EquilibriumOptions& options) {
  const bool is_bonded = assessment.contact_model == ContactModel::kBonded;
  if (assessment.equilibrium.outcome == Outcome::kSettled) {
    assess_connections(robot, options, assessment);
    assessment.gaps = find_open_gaps(robot, assessment.equilibrium);
  }
  if (!is_bonded) {
    heed_model(robot, assessment);
  }
  if (assessment.is_stable) {
    decide_stable(robot, assessment);
  } else if (assessment.reasons.empty()) {
    decide_falling(assessment);
  }
  add_contact_remarks(assessment);
  add_load_remarks(robot, assessment);
  return assessment;
}

Assessment assess_once(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  Assessment assessment = assess_rigidly(robot);
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

Assessment assess_rigidly(const model::Robot& robot) {
  Assessment assessment;
  assessment.simplified = assess_rigid_body(robot);
  assessment.stability_rule = stability_rule(robot);
  assessment.rigid = rigid_stability(robot, assessment.stability_rule, assessment.simplified);
  assessment.is_stable = assessment.rigid.holds();
  return assessment;
}

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
  Assessment assessment = assess_rigidly(robot);
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
