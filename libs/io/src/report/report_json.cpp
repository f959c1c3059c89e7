// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sstream>

#include "connection_list.hpp"
#include "holdfast/io/report.hpp"
#include "holdfast/verdict/connection_law.hpp"
#include "ordered_blocks.hpp"
#include "report/deformed_report.hpp"
#include "report/limit_report.hpp"

namespace holdfast::io {
namespace {

/// Values of a long array that one thread writes at a time: of connections some 170 KB.
constexpr std::size_t kBlockValues = 512;

void write_pair(JsonStream& json, double first, double second) {
  json.begin_array();
  json.value(first);
  json.value(second);
  json.end_array();
}

void write_range(JsonStream& json, std::string_view key, const verdict::LoadRange* range) {
  json.key(key);
  if (range != nullptr) {
    write_pair(json, range->low, range->high);
  } else {
    json.value(nullptr);
  }
}

void write_ends(JsonStream& json, const std::array<base::Cell, 2>& ends) {
  const auto& [a, b] = ends;
  json.begin_array();
  json.value(a);
  json.value(b);
  json.end_array();
}

void write_rigid_body(JsonStream& json, const verdict::RigidBody& body) {
  json.begin_object();
  json.member("stable", body.is_stable);
  json.member("margin_mm", body.margin_mm);
  json.key("edge_mm");
  if (body.edge) {
    json.begin_array();
    for (const verdict::PlanPoint& end : *body.edge) {
      write_pair(json, end.x, end.y);
    }
    json.end_array();
  } else {
    json.value(nullptr);
  }
  json.key("centre_of_mass_mm");
  write_pair(json, body.centre_of_mass.x, body.centre_of_mass.y);
  json.end_object();
}

void write_vector(JsonStream& json, std::string_view key, const limit::Vector3& vector) {
  json.key(key);
  json.begin_array();
  for (const double number : vector) {
    json.value(number);
  }
  json.end_array();
}

void write_motion(JsonStream& json, const limit::Motion& motion) {
  json.begin_object();
  json.member("text", limit::text(motion));
  write_vector(json, "velocity", motion.velocity);
  write_vector(json, "angular", motion.angular);
  write_vector(json, "from_mm", motion.from_mm);
  write_vector(json, "to_mm", motion.to_mm);
  json.end_object();
}

void write_rigid(JsonStream& json, const limit::RigidStability& rigid) {
  using limit::RigidAnswer;
  json.begin_object();
  json.member("holds", rigid.answer == RigidAnswer::kUndecided ? std::nullopt
                                                               : std::optional(rigid.holds()));
  json.member("answer", limit::name(rigid.answer));
  json.member("margin", rigid.margin);
  json.member("friction_needed", rigid.friction_needed);
  json.member("tilt_margin_deg", rigid.tilt_margin_deg);
  json.key("motion");
  if (rigid.motion) {
    write_motion(json, *rigid.motion);
  } else {
    json.value(nullptr);
  }
  json.end_object();
}

void write_stability(JsonStream& json, const verdict::Assessment& assessment) {
  const verdict::ModelStability& model = assessment.model;
  json.begin_object();
  json.key("simplified");
  write_rigid_body(json, assessment.simplified);
  json.key("model");
  json.begin_object();
  json.member("stable", model.is_settled ? std::optional(model.is_stable) : std::nullopt);
  json.member("settled", model.is_settled);
  json.end_object();
  json.key("rigid");
  write_rigid(json, assessment.rigid);
  json.member("stable", verdict::known_stability(assessment));
  json.end_object();
}

/// The ratio of a limit; none if it is unlimited.
std::optional<double> ratio_of(const std::array<double, model::kLimitCount>& ratios,
                               model::Limit limit) {
  const double ratio = ratios[static_cast<std::size_t>(limit)];
  return ratio == -model::ConnectorLaw::kUnlimited ? std::nullopt : std::optional(ratio);
}

void write_connection(JsonStream& json, const model::Robot& robot,
                      const verdict::ConnectionLaws& laws, std::size_t connection,
                      const verdict::Assessment& assessment) {
  const verdict::ConnectionResult& result = assessment.connections[connection];
  const model::Connection& pair = robot.connections()[connection];
  const auto ratios = laws.limit_ratios(pair, result);
  const auto [a, b] = model::ends(robot, connection);
  json.begin_object();
  json.key("a");
  json.value(a);
  json.key("b");
  json.value(b);
  if (const std::int32_t body = robot.body(pair); body != model::OwnConnector::kNoBody) {
    json.member("body", body);
  }
  json.member("load_ratio", result.load_ratio);
  json.member("axial_n", result.axial_n);
  json.member("bending_nmm", result.bending_nmm);
  json.member("shear_n", result.shear_n);
  json.member("torsion_nmm", result.torsion_nmm);
  json.member("limit", model::name(laws.limit(pair, result)));
  json.member("shear_ratio", ratio_of(ratios, model::Limit::kShears));
  json.member("torsion_ratio", ratio_of(ratios, model::Limit::kTwists));
  json.member("gap_mm", assessment.gaps_mm.empty()
                            ? laws.gap_mm(pair, assessment.equilibrium.displacement,
                                          assessment.equilibrium.displacement_low)
                            : assessment.gaps_mm[connection]);
  json.end_object();
}

void write_several(JsonStream& json, const verdict::Assessment& assessment) {
  if (!assessment.several) {
    json.value(nullptr);
    return;
  }
  const verdict::SeveralSolutions& several = *assessment.several;
  json.begin_object();
  json.member("found", several.found_count);
  write_range(json, "regularised", &several.regularised);
  write_range(json, "unilateral", several.unilateral ? &*several.unilateral : nullptr);
  json.end_object();
}

/// A number; none if it is infinite.
std::optional<double> if_finite(double number) {
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

void write_mode(JsonStream& json, const std::optional<verdict::BucklingMode>& mode) {
  json.key("mode");
  if (!mode) {
    json.value(nullptr);
    return;
  }
  json.begin_object();
  json.key("cell");
  json.value(mode->cell);
  write_vector(json, "direction", mode->direction);
  json.end_object();
}

void write_second_order(JsonStream& json, const verdict::Assessment& assessment) {
  using solver::BucklingAnswer;
  if (!assessment.second_order) {
    json.value(nullptr);
    return;
  }
  const verdict::SecondOrder& second = *assessment.second_order;
  const auto bound = [&](BucklingAnswer answer) {
    return second.answer == answer ? if_finite(second.factor) : std::nullopt;
  };
  json.begin_object();
  json.member("buckling_factor", second.buckling_factor());
  json.member("buckling_factor_above", bound(BucklingAnswer::kAbove));
  json.member("buckling_factor_at_most", bound(BucklingAnswer::kAtMost));
  json.member("elastic_modulus_needed_mpa", second.elastic_modulus_needed_mpa());
  write_mode(json, second.mode);
  json.member("load_ratio_max", second.load_ratio_max);
  json.member("rotation_max_rad", second.rotation_max_rad);
  json.member("displacement_max_mm", second.displacement_max_mm);
  json.member("edge_strain_max", second.edge_strain_max);
  json.member("facet_reserve_max", if_finite(second.facet_reserve_max));
  json.member("trusted", second.trust == verdict::Trust::kNotCertain
                             ? std::nullopt
                             : std::optional(second.trust == verdict::Trust::kTrusted));
  json.end_object();
}

const char* solver_name(solver::Method method, solver::Precision precision) {
  if (method != solver::Method::kMultigrid) {
    return "sparse direct, 6x6 block LU";
  }
  return precision == solver::Precision::kSingle
             ? "conjugate gradients with multigrid"
             : "conjugate gradients with multigrid in double precision";
}

const char* outcome_name(solver::Outcome outcome) {
  switch (outcome) {
    case solver::Outcome::kSettled:
      return "settled";
    case solver::Outcome::kNotSettled:
      return "not_settled";
    case solver::Outcome::kSingular:
      return "singular";
    case solver::Outcome::kTooLarge:
      return "too_large";
    case solver::Outcome::kNotSought:
      return "not_sought";
    case solver::Outcome::kTooSlow:
      break;
  }
  return "too_slow";
}

/// The contact model of one attempt: without contact that of the whole assessment.
verdict::ContactModel attempted_model(const verdict::Assessment& assessment,
                                      const solver::Attempt& attempt) {
  using verdict::ContactModel;
  const bool has_contact = assessment.contact_model == ContactModel::kRegularised ||
                           assessment.contact_model == ContactModel::kUnilateral;
  if (!has_contact) {
    return assessment.contact_model;
  }
  return attempt.law == mechanics::ContactLaw::kUnilateral ? ContactModel::kUnilateral
                                                           : ContactModel::kRegularised;
}

void write_attempts(JsonStream& json, const verdict::Assessment& assessment) {
  json.begin_array();
  for (const solver::Attempt& attempt : assessment.equilibrium.attempts) {
    json.begin_object();
    json.member("name", solver_name(attempt.method, attempt.precision));
    json.member("contact_model", verdict::name(attempted_model(assessment, attempt)));
    json.member("outcome", outcome_name(attempt.outcome));
    json.member("iterations", attempt.steps);
    json.member("multigrid_iterations", attempt.iteration_count);
    json.end_object();
  }
  json.end_array();
}

void write_solver(JsonStream& json, const ReportEntry& entry) {
  const solver::Equilibrium& equilibrium = entry.assessment->equilibrium;
  json.begin_object();
  json.member("name", solver_name(equilibrium.method, equilibrium.precision));
  json.member("iterations", equilibrium.steps);
  json.member("multigrid_iterations", equilibrium.iteration_count);
  json.member("seconds", entry.seconds);
  if (equilibrium.attempts.size() > 1) {
    json.key("attempts");
    write_attempts(json, *entry.assessment);
  }
  json.end_object();
}

void write_proof(JsonStream& json, const ReportEntry& entry) {
  const certificate::Verification& found = entry.proof->verification;
  const verdict::LoadRange range{.low = found.ratio_low, .high = found.ratio_high};
  json.begin_object();
  json.member("proved", found.is_proved);
  write_range(json, "load_ratio_range", found.is_proved ? &range : nullptr);
  json.member("reason", found.is_proved ? std::nullopt : std::optional(found.reason));
  json.member("digest", found.is_proved
                            ? std::optional(certificate::digest(entry.proof->certificate))
                            : std::nullopt);
  json.member("solves", entry.proof->solve_count);
  json.member("seconds", entry.proof_seconds);
  json.end_object();
}

/// Writes one report; only a window of its connections is in memory at any time.
class Writer {
 public:
  Writer(std::ostream& out, const ReportEntry& entry, const ReportOptions& options)
      : out_(out), entry_(entry), options_(options), json_(text_) {}

  void write(const MoreKeys& more) {
    json_.begin_object();
    write_head();
    write_overload();
    json_.key("second_order");
    write_second_order(json_, *entry_.assessment);
    write_connections();
    write_tail();
    if (more) {
      more(json_);
    }
    json_.end_object();
    drain();
  }

 private:
  void write_head() {
    const model::Robot& robot = *entry_.robot;
    const verdict::Assessment& assessment = *entry_.assessment;
    const WholeRobot whole =
        entry_.whole != nullptr
            ? *entry_.whole
            : WholeRobot{.existing_count = robot.modules().size() - robot.planned_count(),
                         .planned_count = robot.planned_count(),
                         .facet_count = robot.ground_count(),
                         .fixed_count = robot.fixed_count(),
                         .broken = {}};
    write_report_head(json_, {.command = entry_.command,
                              .origin = entry_.origin,
                              .module_count = whole.existing_count + whole.planned_count});
    json_.member("name", entry_.name);
    json_.member("verdict", verdict::name(assessment.verdict));
    write_reasons();
    json_.key("modules");
    json_.begin_object();
    json_.member("existing", whole.existing_count);
    json_.member("planned", whole.planned_count);
    json_.member("on_ground", whole.facet_count);
    json_.member("fixed", whole.fixed_count);
    json_.end_object();
    json_.key("stability");
    write_stability(json_, assessment);
    write_pieces();
  }

  void write_reasons() {
    json_.key("reasons");
    json_.begin_array();
    for (const verdict::Reason& reason : entry_.assessment->reasons) {
      json_.value(reason_text(*entry_.robot, reason));
    }
    json_.end_array();
    json_.key("reason_codes");
    json_.begin_array();
    for (const verdict::Reason& reason : entry_.assessment->reasons) {
      json_.value(verdict::name(reason.code));
    }
    json_.end_array();
  }

  /// Writes what is known of each piece of a robot that is in several.
  void write_pieces() {
    if (entry_.assessment->pieces.empty()) {
      return;
    }
    json_.key("pieces");
    json_.begin_array();
    for (const verdict::PieceAnswer& piece : entry_.assessment->pieces) {
      json_.begin_object();
      json_.member("modules", piece.module_count);
      json_.member("first", piece.first);
      json_.member("verdict", verdict::name(piece.verdict));
      json_.member("load_ratio_max", piece.load_ratio_max);
      json_.member("margin_mm", piece.margin_mm);
      json_.end_object();
    }
    json_.end_array();
  }

  void write_overload() {
    const model::Robot& robot = *entry_.robot;
    const verdict::Assessment& assessment = *entry_.assessment;
    json_.key("overload");
    json_.begin_object();
    json_.member("meaningful", assessment.is_stable && assessment.load_ratio_max.has_value());
    json_.member("load_ratio_max", assessment.load_ratio_max);
    write_range(json_, "load_ratio_range",
                assessment.load_ratio_max ? &assessment.load_ratio_range : nullptr);
    json_.key("at");
    if (assessment.worst && assessment.whole) {
      write_ends(json_, assessment.whole->worst);
    } else if (assessment.worst) {
      write_ends(json_, model::ends(robot, *assessment.worst));
    } else {
      json_.value(nullptr);
    }
    json_.key("broken");
    write_list(entry_.whole != nullptr ? entry_.whole->broken.size() : assessment.broken.size(),
               [&](JsonStream& json, std::size_t i) {
                 write_ends(json, entry_.whole != nullptr
                                      ? entry_.whole->broken[i]
                                      : model::ends(robot, assessment.broken[i]));
               },
               {});
    json_.member("weight_factor", assessment.weight_factor);
    json_.end_object();
  }

  void write_connections() {
    const verdict::Assessment& assessment = *entry_.assessment;
    constexpr ConnectionChoice kNone{.kind = ConnectionChoice::Kind::kLargest, .count = 0};
    const ConnectionList list(assessment, entry_.whole != nullptr ? kNone : options_.connections);
    const verdict::ConnectionLaws laws(*entry_.robot);
    json_.key("connections");
    write_list(
        list.size(),
        [&](JsonStream& json, std::size_t i) {
          write_connection(json, *entry_.robot, laws, list[i], assessment);
        },
        options_.progress);
  }

  /// A long array, made by all threads: write_one(json, i) appends its i-th value.
  template <class WriteOne>
  void write_list(std::size_t count, const WriteOne& write_one,
                  const std::function<void(double)>& progress) {
    json_.begin_array();
    drain();
    write_items(out_, count, kBlockValues, options_.thread_count, progress,
                [&](std::size_t begin, std::size_t end, std::string& text) {
                  JsonStream part = json_.part(text, begin == 0);
                  for (std::size_t i = begin; i < end; ++i) {
                    write_one(part, i);
                  }
                });
    if (count > 0) {
      json_.end_parts();
    }
    json_.end_array();
  }

  void write_tail() {
    const verdict::Assessment& assessment = *entry_.assessment;
    json_.member("contact_model", verdict::name(assessment.contact_model));
    json_.key("several_solutions");
    write_several(json_, assessment);
    json_.key("solver");
    write_solver(json_, entry_);
    json_.key("warnings");
    json_.begin_array();
    for (const std::string& warning : entry_.warnings) {
      json_.value(warning);
    }
    json_.end_array();
    if (entry_.proof != nullptr) {
      json_.key("proof");
      write_proof(json_, entry_);
    }
    if (entry_.limit != nullptr) {
      write_limit(json_, entry_);
    }
    if (entry_.is_deformed) {
      write_deformed(json_, entry_);
    }
  }

  void drain() {
    out_ << text_;
    text_.clear();
  }

  std::ostream& out_;
  const ReportEntry& entry_;
  const ReportOptions& options_;
  std::string text_;
  JsonStream json_;
};

}  // namespace

void write_report_json(std::ostream& out, const ReportEntry& entry, const ReportOptions& options,
                       const MoreKeys& more) {
  Writer(out, entry, options).write(more);
}

std::string write_report_json(const ReportEntry& entry) {
  std::ostringstream out;
  write_report_json(out, entry);
  return std::move(out).str();
}

std::string write_error_json(const base::Error& error, const ReportOrigin& origin) {
  std::string text;
  JsonStream json(text);
  json.begin_object();
  write_report_head(json, {.command = "check", .origin = origin});
  json.member("name", std::string_view(origin.file));
  json.member("error", std::string_view(error.message));
  json.member("where", std::string_view(error.where));
  json.end_object();
  return text;
}

}  // namespace holdfast::io
