// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/proof/proof.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "holdfast/base/double_double.hpp"

namespace holdfast::proof {
namespace {

using base::DoubleDouble;
using certificate::Certificate;
using certificate::Integer;
using certificate::Law;
using certificate::Residual;
using certificate::Residuals;
using mechanics::ContactState;
using solver::LinearOutcome;
using solver::LinearSystem;
using verdict::Assessment;
using verdict::ContactModel;
using Vec = base::Vec6<double>;

/// The error of a correction by multigrid, as a share of it: as many digits as its single precision
/// gives cheaply.
constexpr double kTolerance = 1e-5;

/// The error of the response to a tilting facet, which one correction has to bring: a portal of
/// 5,000 needs 1e-6, else all are sought twice. Most do with 1e-4, which saves a quarter of the
/// time.
constexpr double kResponseTolerance = 1e-6;

/// Corrections at most; each brings five digits, or ten and more with the direct solver.
constexpr int kPassMax = 8;

/// Residuals below so many times the rounding of one force are as good as none, and a pass that
/// does not bring this factor is the last.
constexpr double kRoundings = 4;
constexpr double kGain = 0.3;

/// The number of spare bits that are left for the solution to grow.
constexpr int kSpareBits = 6;

Law law_of(ContactModel model) {
  switch (model) {
    case ContactModel::kRegularised:
      return Law::kRegularised;
    case ContactModel::kUnilateral:
      return Law::kUnilateral;
    case ContactModel::kNone:
    case ContactModel::kBonded:
      break;
  }
  return Law::kBonded;
}

certificate::Material material_of(const model::Material& material) {
  return {.pitch = material.pitch_mm,
          .facet = material.facet_mm,
          .area = material.section_area_mm2,
          .moment_x = material.moment_x_mm4,
          .moment_y = material.moment_y_mm4,
          .torsion = material.torsion_mm4,
          .poisson = material.poisson_ratio,
          .mass = material.mass_kg,
          .gravity = material.gravity_m_s2,
          .strength_vertical = material.strength_vertical_n,
          .strength_lateral = material.strength_lateral_n,
          .gamma = material.contact_gamma};
}

/// The certificate without its fields.
Certificate certificate_of(const model::Robot& robot, const Assessment& assessment) {
  Certificate made;
  made.law = law_of(assessment.contact_model);
  made.material = material_of(robot.material());
  made.support_z = robot.support_z();
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const model::Module& module = robot.modules()[i];
    certificate::Module& copy = made.modules.emplace_back();
    copy.cell = {module.cell.x, module.cell.y, module.cell.z};
    copy.is_fixed = module.support == model::Support::kFixed;
    made.planned_count += module.is_planned ? 1 : 0;
    if (module.support == model::Support::kGround && made.law != Law::kBonded) {
      const ContactState state = solver::contact_of(robot, assessment.equilibrium, i);
      copy.state = {.is_pressed = state.pressed, .tilt_x = state.tilt_x, .tilt_y = state.tilt_y};
    }
  }
  return made;
}

/// Says why there is nothing to prove, or empty.
std::string find_obstacle(const model::Robot& robot, const Assessment& assessment) {
  if (!assessment.is_stable) {
    return "the robot topples, which the rigid body decides in integers";
  }
  if (const auto beyond = model::find_beyond_paper(robot)) {
    return "the robot has " + *beyond + ", and certificates know cubes on a floor only";
  }
  if (robot.released_count() > 0) {
    return "the robot has neighbours that are not connected, and a certificate connects all";
  }
  if (assessment.equilibrium.outcome != solver::Outcome::kSettled) {
    return "no equilibrium was found";
  }
  if (assessment.equilibrium.open_but_held_count > 0) {
    return "lifted feet would touch down again if they slid freely";
  }
  return robot.modules().empty() ? "there is no module" : "";
}

/// Makes the fields of a certificate.
class Prover {
 public:
  Prover(const model::Robot& robot, const Assessment& assessment, const ProofOptions& options,
         Proof& proof)
      : robot_(robot), assessment_(assessment), options_(options), proof_(proof) {
    const model::Material& material = robot.material();
    force_n_ = model::module_weight_n(material);
    lever_mm_ = material.pitch_mm / 2;
    displacement_mm_ =
        force_n_ * material.pitch_mm / (material.elastic_modulus_mpa * material.section_area_mm2);
  }

  void run() {
    Certificate& made = proof_.certificate;
    made = certificate_of(robot_, assessment_);
    made.bits = bits_for(assessment_.equilibrium.displacement);
    made.fields.emplace_back(made.modules.size());
    add(assessment_.equilibrium.displacement, 0);
    std::size_t tilted = 0;
    for (const certificate::Module& module : made.modules) {
      tilted += made.law == Law::kRegularised && module.state.is_tilted() ? 1 : 0;
    }
    made.fields.resize(1 + tilted, certificate::Field(made.modules.size()));
    const solver::Equilibrium& known = assessment_.equilibrium;
    const bool is_done = improve_all(known.method, known.precision) ||
                         improve_all(solver::Method::kMultigrid, solver::Precision::kDouble) ||
                         improve_all(solver::Method::kDirect, known.precision);
    if (!is_done) {
      proof_.verification = certificate::verify(made);
    }
    take_displacements();
  }

 private:
  /// The number of bits after the point for which the largest displacement leaves room.
  int bits_for(const std::vector<Vec>& displacement) const {
    double largest = 1;
    for (const Vec& u : displacement) {
      for (std::size_t k = 0; k < 6; ++k) {
        largest = std::max(largest, std::abs(scaled(u[k], k)));
      }
    }
    const int room = certificate::kMagnitudeBitsMax - kSpareBits - std::ilogb(largest);
    return std::clamp(room, 0, certificate::kBitsMax);
  }

  /// Converts mm and rad to the certificate's unit.
  double scaled(double displacement, std::size_t k) const {
    return (k < 3 ? displacement : displacement * lever_mm_) / displacement_mm_;
  }

  /// Takes the displacements in 106 bits: the loads of a slender robot are in the digits that a
  /// double does not have.
  void take_displacements() {
    const double unit = std::ldexp(displacement_mm_, -proof_.certificate.bits);
    for (const certificate::Six& six : proof_.certificate.fields[0]) {
      Vec& high = proof_.displacement.emplace_back();
      Vec& low = proof_.displacement_low.emplace_back();
      for (std::size_t k = 0; k < 6; ++k) {
        const auto upper = static_cast<double>(six[k]);
        const DoubleDouble steps(upper, static_cast<double>(six[k] - static_cast<Integer>(upper)));
        const DoubleDouble u = steps * unit / (k < 3 ? 1 : lever_mm_);
        high[k] = u.high;
        low[k] = u.low;
      }
    }
  }

  void add(const std::vector<Vec>& displacement, std::size_t field) {
    const double unit = std::ldexp(1.0, proof_.certificate.bits);
    const double most = std::ldexp(1.0, certificate::kMagnitudeBitsMax);
    for (std::size_t i = 0; i < displacement.size(); ++i) {
      for (std::size_t k = 0; k < 6; ++k) {
        const double step = scaled(displacement[i][k], k) * unit;
        if (std::abs(step) < most && !proof_.certificate.modules[i].is_fixed) {
          proof_.certificate.fields[field][i][k] += static_cast<Integer>(step);
        }
      }
    }
  }

  /// Improves all fields; returns false if a solver gave up.
  bool improve_all(solver::Method method, solver::Precision precision) {
    const std::unique_ptr<LinearSystem> system =
        solver::make_linear_system(robot_, {.memory_bytes_max = options_.memory_bytes_max,
                                            .method = method,
                                            .precision = precision,
                                            .is_bonded = proof_.certificate.law == Law::kBonded,
                                            .thread_count = options_.thread_count});
    if (!system) {
      return false;
    }
    take_states(*system);
    const Residuals residuals(proof_.certificate);
    bool is_done = improve(0, kPassMax, residuals, *system);
    // What tilting facets do is needed roughly; seldom once more.
    for (int round = 0; round < 2 && is_done && !proof_.is_proved(); ++round) {
      for (std::size_t field = 1; field < proof_.certificate.fields.size(); ++field) {
        is_done = is_done && improve(field, 1, residuals, *system);
      }
      proof_.verification = certificate::verify(proof_.certificate);
    }
    return is_done;
  }

  /// Puts the facets into the assessment's states; of the unilateral law those that press are held,
  /// the others are not.
  void take_states(LinearSystem& system) const {
    const bool is_unilateral = proof_.certificate.law == Law::kUnilateral;
    system.set_law({.law = is_unilateral ? mechanics::ContactLaw::kUnilateral
                                         : mechanics::ContactLaw::kRegularised,
                    .gamma = is_unilateral ? kUnilateralGamma : robot_.material().contact_gamma});
    for (std::size_t i = 0; i < system.facets().size(); ++i) {
      const ContactState& state = assessment_.equilibrium.contact[i];
      system.set_facet(i, state, !is_unilateral || state.pressed);
    }
  }

  /// Refines iteratively: the residual is that of the certificate's integers, which have the digits
  /// that differences of displacements lose.
  bool improve(std::size_t field, int pass_max, const Residuals& residuals, LinearSystem& system) {
    double before = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < pass_max; ++pass) {
      const Residual left = residuals.of(field);
      if (left.largest <= kRoundings * left.rounding || left.largest > kGain * before) {
        return true;
      }
      before = left.largest;
      system.set_loads(model::Loads(force_of(left)));
      if (system.solve(field == 0 ? kTolerance : kResponseTolerance) != LinearOutcome::kSolved) {
        return false;
      }
      ++proof_.solve_count;
      add(system.displacement(), field);
    }
    return true;
  }

  /// The forces of a residual in N and N mm.
  std::vector<Vec> force_of(const Residual& residual) const {
    const double unit = std::ldexp(force_n_, -proof_.certificate.bits);
    std::vector<Vec> force(residual.force.size());
    for (std::size_t i = 0; i < force.size(); ++i) {
      for (std::size_t k = 0; k < 6; ++k) {
        force[i][k] = residual.force[i][k] * unit * (k < 3 ? 1 : lever_mm_);
      }
    }
    return force;
  }

  /// The weak springs of the approximate tangent; what they add is refined away.
  static constexpr double kUnilateralGamma = 1e-9;

  const model::Robot& robot_;
  const Assessment& assessment_;
  const ProofOptions& options_;
  Proof& proof_;
  double force_n_ = 0;  ///< The certificate's units.
  double lever_mm_ = 0;
  double displacement_mm_ = 0;
};

}  // namespace

Proof prove(const model::Robot& robot, const Assessment& assessment, const ProofOptions& options) {
  Proof proof;
  proof.verification.reason = find_obstacle(robot, assessment);
  if (proof.verification.reason.empty()) {
    Prover(robot, assessment, options, proof).run();
  }
  return proof;
}

namespace {

/// The verdict of the range, by the rule that a ratio within kLoadRatioTie below 1 counts as 1.
verdict::Verdict verdict_of(const certificate::Verification& found) {
  const double limit = 1 - verdict::kLoadRatioTie;
  if (found.ratio_low >= limit) {
    return verdict::Verdict::kOverload;
  }
  return found.ratio_high < limit ? verdict::Verdict::kSafe : verdict::Verdict::kUndecided;
}

verdict::ReasonCode what_is_proved(ContactModel model) {
  switch (model) {
    case ContactModel::kRegularised:
      return verdict::ReasonCode::kProvedOneSolution;
    case ContactModel::kUnilateral:
      return verdict::ReasonCode::kProvedForces;
    case ContactModel::kNone:
    case ContactModel::kBonded:
      break;
  }
  return verdict::ReasonCode::kProvedUnique;
}

/// Takes the proved loads over. The first reason of an assessment that stands is about the loads,
/// and all others stay true.
void take_loads(const model::Robot& robot, const Proof& proof, bool is_changed, int thread_count,
                Assessment& assessment) {
  assessment.equilibrium.displacement = proof.displacement;
  assessment.equilibrium.displacement_low = proof.displacement_low;
  assessment.equilibrium.alternative = proof.displacement;
  Assessment fresh = verdict::assess_equilibrium(robot, assessment.equilibrium, thread_count);
  assessment.connections = std::move(fresh.connections);
  assessment.load_ratio_max = fresh.load_ratio_max;
  assessment.worst = fresh.worst;
  assessment.broken = std::move(fresh.broken);
  assessment.weight_factor = fresh.weight_factor;
  if (fresh.verdict == assessment.verdict) {
    assessment.reasons.front() = std::move(fresh.reasons.front());
  } else if (is_changed) {
    assessment.reasons.erase(assessment.reasons.begin());
  }
}

}  // namespace

void apply(const model::Robot& robot, const Proof& proof, Assessment& assessment,
           int thread_count) {
  const certificate::Verification& found = proof.verification;
  if (assessment.verdict == verdict::Verdict::kUnstable) {
    return;
  }
  const bool holds = found.is_proved && found.is_standing;
  verdict::Verdict verdict = holds ? verdict_of(found) : verdict::Verdict::kUndecided;
  if (assessment.several && verdict != assessment.verdict) {
    verdict = verdict::Verdict::kUndecided;  // Nothing is proved of the other solutions.
  }
  const auto doubt = holds ? verdict::second_order_doubt(assessment) : std::nullopt;
  if (doubt) {
    verdict = verdict::Verdict::kUndecided;  // What is proved is linear.
  }
  const bool is_changed = verdict != std::exchange(assessment.verdict, verdict);
  if (!holds) {
    assessment.reasons = {{.code = verdict::ReasonCode::kNotProved,
                           .quoted = found.is_proved
                                         ? "the robot stands, but not by more than rounding"
                                         : found.reason}};
    return;
  }
  take_loads(robot, proof, is_changed, thread_count, assessment);
  if (doubt && assessment.reasons.front().code != doubt->code) {
    assessment.reasons.insert(assessment.reasons.begin(), *doubt);
  }
  assessment.load_ratio_range = {.low = found.ratio_low, .high = found.ratio_high};
  assessment.reasons.push_back({.code = what_is_proved(assessment.contact_model)});
}

}  // namespace holdfast::proof
