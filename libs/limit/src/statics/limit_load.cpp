// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/limit/limit_load.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "program/interior_point.hpp"
#include "program/kkt_system.hpp"
#include "program/wrench.hpp"
#include "statics/determinate.hpp"

namespace holdfast::limit {
namespace {

using Clock = std::chrono::steady_clock;

/// What a joint's two bodies do there, relative to each other, in its frame.
struct Opening {
  double across = 0;
  double apart = 0;    ///< The most that its edge opens.
  double turning = 0;  ///< About z', at its lever, or at the structure's length.
};

Opening opening_of(const Structure& structure, const Joint& joint,
                   const std::vector<base::Vec6<double>>& velocities) {
  base::Vec6<double> relative = velocity_at(
      velocities[base::at(joint.a)], structure.bodies[base::at(joint.a)].centre_mm, joint.place_mm);
  if (joint.b != Joint::kGround) {
    const base::Vec6<double> other =
        velocity_at(velocities[base::at(joint.b)], structure.bodies[base::at(joint.b)].centre_mm,
                    joint.place_mm);
    for (std::size_t i = 0; i < 6; ++i) {
      relative[i] -= other[i];
    }
  }
  const Vector3 speed = {relative[0], relative[1], relative[2]};
  const Vector3 spin = {relative[3], relative[4], relative[5]};
  const double bend_x = dot(spin, joint.frame[0]);
  const double bend_y = dot(spin, joint.frame[1]);
  const bool bends = (joint.carries & kCarriesBending) != 0 && std::isfinite(joint.law.strength_n);
  const double lever = bends ? joint.law.lever_mm : 0;
  const double bending = joint.law.bending == model::BendingLaw::kRound
                             ? std::hypot(bend_x, bend_y)
                             : std::abs(bend_x) + std::abs(bend_y);
  return {.across = std::hypot(dot(speed, joint.frame[0]), dot(speed, joint.frame[1])),
          .apart = dot(speed, joint.frame[2]) + lever * bending,
          .turning = std::abs(dot(spin, joint.frame[2])) * structure.length_mm};
}

std::vector<Yield> yields_of(const Structure& structure,
                             const std::vector<base::Vec6<double>>& velocities) {
  constexpr double kStill = 1e-5;  // Of the fastest; interior point methods leave 1e-7.
  std::vector<Yield> yields;
  for (std::size_t i = 0; i < structure.joints.size() && !velocities.empty(); ++i) {
    const Joint& joint = structure.joints[i];
    const Opening opening = opening_of(structure, joint, velocities);
    const double speed = std::max({opening.across, opening.apart, opening.turning});
    if (speed <= kStill) {
      continue;
    }
    const bool has_friction = joint.law.friction.has_value();
    // Friction, taken as a constraint, parts what slides.
    const bool opens =
        opening.apart > kStill &&
        (!has_friction || opening.across <= *joint.law.friction * opening.apart * (1 - kStill));
    const model::Limit limit = opens                              ? model::Limit::kOpens
                               : has_friction                     ? model::Limit::kSlips
                               : opening.across > opening.turning ? model::Limit::kShears
                                                                  : model::Limit::kTwists;
    yields.push_back({.joint = i, .a = joint.a, .b = joint.b, .limit = limit, .speed = speed});
  }
  std::ranges::stable_sort(yields, std::greater{}, &Yield::speed);
  return yields;
}

/// Makes Mechanism::velocities of those of the groups; empty if nothing moves.
std::vector<base::Vec6<double>> velocities_of(const Structure& structure, const Part& part,
                                              const Eigen::VectorXd& of_groups) {
  std::vector<base::Vec6<double>> velocities(structure.bodies.size());
  if (of_groups.size() == 0) {
    return {};
  }
  double power = 0;
  double largest = 0;
  for (std::size_t body = 0; body < velocities.size(); ++body) {
    if (part.group[body] == Part::kNone) {
      continue;
    }
    const auto group = base::at(part.group[body]);
    base::Vec6<double> velocity;
    for (std::size_t i = 0; i < 6; ++i) {
      velocity[i] =
          of_groups[static_cast<Eigen::Index>(6 * group + i)] / (i < 3 ? 1 : structure.length_mm);
    }
    velocities[body] = velocity_at(velocity, part.centres[group], structure.bodies[body].centre_mm);
    power += base::dot(velocities[body], structure.bodies[body].load);
    for (std::size_t i = 0; i < 6; ++i) {
      largest =
          std::max(largest, std::abs(velocities[body][i]) * (i < 3 ? 1 : structure.length_mm));
    }
  }
  constexpr double kNone = 1e-9;  // Of one over the unit of loads: no price but rounding.
  if (largest < kNone) {
    return {};
  }
  for (base::Vec6<double>& velocity : velocities) {
    for (double& component : velocity) {
      component /= power < 0 ? -largest : largest;  // Loads do work.
    }
  }
  return velocities;
}

/// Narrows the bracket: more joints become free, until both bounds meet.
class Search {
 public:
  Search(const Structure& structure, const LimitOptions& options)
      : structure_(structure),
        options_(options),
        end_(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                std::chrono::duration<double>(options.seconds_max))) {
    set_known_forces();
  }

  LimitLoad run() {
    constexpr int kRoundMax = 40;
    for (int round = 0; round < kRoundMax && result_.low < kFactorMax && round_is_useful();
         ++round) {
    }
    finish();
    return std::move(result_);
  }

 private:
  double seconds_left() const { return std::chrono::duration<double>(end_ - Clock::now()).count(); }

  bool is_narrow() const {
    constexpr double kNothing = 1e-9;
    return result_.high - result_.low <= std::max(options_.tolerance * result_.high, kNothing);
  }

  /// What known forces prove. The joints nearest to their limits, and those beside them, are free
  /// at first; all are if that is no great work.
  void set_known_forces() {
    const std::size_t count = structure_.joints.size();
    is_free_.assign(count, 1);
    if (options_.known_forces.size() != count) {
      return;
    }
    for (const base::Vec6<double>& force : options_.known_forces) {
      ratios_.push_back(joint_ratio(structure_.joints[ratios_.size()], force));
    }
    result_.low = std::max(factor_of(ratios_), factor_of(determinate_ratios()));
    whole_work_ = factor_work(ConeProgram(structure_, whole(structure_)));
    if (whole_work_ <= kWorkMax) {
      return;
    }
    double largest = 0;
    for (const double ratio : ratios_) {
      largest = std::isfinite(ratio) ? std::max(largest, ratio) : largest;
    }
    constexpr double kNearLargest = 0.8;
    for (std::size_t i = 0; i < count; ++i) {
      is_free_[i] = ratios_[i] >= kNearLargest * largest ? 1 : 0;
    }
    free_beside_free();
  }

  std::vector<double> determinate_ratios() const {
    std::vector<double> ratios;
    for (const base::Vec6<double>& force : determinate_forces(structure_, options_.known_forces)) {
      ratios.push_back(joint_ratio(structure_.joints[ratios.size()], force));
    }
    return ratios;
  }

  /// The factor up to which forces of these ratios hold; 0 for none.
  static double factor_of(const std::vector<double>& ratios) {
    if (ratios.empty() ||
        !std::ranges::all_of(ratios, [](double ratio) { return std::isfinite(ratio); })) {
      return 0;
    }
    return 1 / std::max(1 / kFactorMax, *std::ranges::max_element(ratios));
  }

  /// Products of two blocks: half a second, that of a solid of 2,700 modules. Chosen by trying both
  /// on robots of 10,000 modules.
  static constexpr double kWorkMax = 1.2e7;

  bool all_free() const {
    return std::ranges::all_of(is_free_, [](char free) { return free != 0; });
  }

  /// Parts whose work is no longer small beside that of the whole do not pay for their rounds.
  bool is_part_small(const Part& upper, const Part& lower) const {
    constexpr double kShareMax = 0.1;
    return factor_work(ConeProgram(structure_, upper)) +
               factor_work(ConeProgram(structure_, lower)) <=
           kShareMax * whole_work_;
  }

  bool round_is_useful() {
    Part upper;
    Part lower;
    if (!all_free()) {
      upper = with_rigid_groups(structure_, is_free_);
      lower = with_known_forces(structure_, is_free_, options_.known_forces);
      if (!is_part_small(upper, lower)) {
        is_free_.assign(is_free_.size(), 1);
      }
    }
    const bool is_whole = all_free();
    if (is_whole) {
      upper = whole(structure_);
    }
    const ProgramBounds around = solve(upper, is_whole ? kFactorMax : 2 * kFactorMax);
    if (around.high < result_.high) {
      result_.high = around.high;
      mechanism_ = velocities_of(structure_, upper, around.velocities);
    }
    if (is_whole) {
      result_.low = std::max(result_.low, around.low);
      return false;
    }
    result_.low = std::max(result_.low, solve(lower, kFactorMax).low);
    if (options_.progress) {
      options_.progress(result_.low, result_.high);
    }
    if (is_narrow() || seconds_left() <= 0) {
      return false;
    }
    free_more();
    return true;
  }

  ProgramBounds solve(const Part& part, double low_enough) {
    const ConeProgram program(structure_, part);
    ++result_.program_count;
    result_.row_count_max =
        std::max(result_.row_count_max, static_cast<std::size_t>(program.loads.size()));
    // A tenth of what is asked for, as both sides of the bracket take their share.
    return maximise_factor(program,
                           {.tolerance = options_.tolerance / 10,
                            .low_enough = low_enough,
                            .thread_count = options_.thread_count},
                           [&] { return seconds_left() <= 0; });
  }

  /// Frees the joints that their known forces would break at the upper bound, and those beside what
  /// moves there; if that is nothing new, those beside all that are free.
  void free_more() {
    std::vector<char> is_near(structure_.bodies.size(), 0);
    for (const Yield& yield : yields_of(structure_, mechanism_)) {
      mark(is_near, yield.joint);
    }
    if (!free_near(is_near)) {
      free_beside_free();
    }
  }

  void free_beside_free() {
    std::vector<char> is_near(structure_.bodies.size(), 0);
    for (std::size_t i = 0; i < is_free_.size(); ++i) {
      if (is_free_[i] != 0) {
        mark(is_near, i);
      }
    }
    free_near(is_near);
  }

  void mark(std::vector<char>& is_near, std::size_t joint) const {
    is_near[base::at(structure_.joints[joint].a)] = 1;
    if (structure_.joints[joint].b != Joint::kGround) {
      is_near[base::at(structure_.joints[joint].b)] = 1;
    }
  }

  bool free_near(const std::vector<char>& is_near) {
    // What the known forces would break at the upper bound; a high one says little.
    const double target = std::min(result_.high, 2 * result_.low);
    bool is_new = false;
    for (std::size_t i = 0; i < is_free_.size(); ++i) {
      const Joint& joint = structure_.joints[i];
      const bool is_beside = is_near[base::at(joint.a)] != 0 ||
                             (joint.b != Joint::kGround && is_near[base::at(joint.b)] != 0);
      if (is_free_[i] == 0 && (is_beside || ratios_[i] * target > 1)) {
        is_free_[i] = 1;
        is_new = true;
      }
    }
    return is_new;
  }

  void finish() {
    if (result_.low >= kFactorMax * (1 - options_.tolerance)) {
      result_.outcome = LimitLoad::Outcome::kUnbounded;
    } else if (is_narrow()) {
      result_.outcome = LimitLoad::Outcome::kFound;
    }
    if (result_.outcome != LimitLoad::Outcome::kUnbounded) {
      result_.mechanism.yields = yields_of(structure_, mechanism_);
      result_.mechanism.velocities = std::move(mechanism_);
    }
  }

  const Structure& structure_;
  const LimitOptions& options_;
  Clock::time_point end_;
  std::vector<char> is_free_;   ///< By joint.
  std::vector<double> ratios_;  ///< By joint, of the known forces; empty if all are free.
  std::vector<base::Vec6<double>> mechanism_;  ///< Velocities at the upper bound.
  double whole_work_ = 0;                      ///< Of factoring the whole once.
  LimitLoad result_;
};

}  // namespace

LimitLoad limit_load(const Structure& structure, const LimitOptions& options) {
  const bool is_loaded = std::ranges::any_of(structure.bodies, [](const Body& body) {
    return !body.is_fixed && body.load != base::Vec6<double>{};
  });
  if (!is_loaded) {
    return {.outcome = LimitLoad::Outcome::kUnbounded, .low = kFactorMax, .mechanism = {}};
  }
  return Search(structure, options).run();
}

double joint_ratio(const Joint& joint, const base::Vec6<double>& force) {
  if (joint.law.strength_n != 0) {
    return std::max(0.0, model::load_ratio(joint.law, force).ratio);
  }
  // A contact: ratios to a strength of one say whether it is pulled, or slips.
  model::ConnectorLaw law = joint.law;
  law.strength_n = 1;
  constexpr double kTie = 1e-9;
  const bool holds = model::load_ratio(law, force).ratio <= kTie * std::abs(force[2]);
  return holds ? 0 : std::numeric_limits<double>::infinity();
}

const char* name(LimitLoad::Outcome outcome) {
  static constexpr std::array<const char*, 3> kNames = {"found", "unbounded", "stopped"};
  return kNames[static_cast<std::size_t>(outcome)];
}

}  // namespace holdfast::limit
