// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "holdfast/io/report.hpp"

namespace holdfast::io {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const base::Cell& cell) { return Json::array({cell.x, cell.y, cell.z}); }

Json to_json(const verdict::PlanPoint& point) { return Json::array({point.x, point.y}); }

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json ends_json(const model::Robot& robot, std::size_t connection) {
  const auto [a, b] = model::ends(robot, connection);
  return Json::array({to_json(a), to_json(b)});
}

Json stability_json(const verdict::Assessment& assessment) {
  const verdict::RigidBody& body = assessment.simplified;
  Json edge;
  if (body.edge) {
    edge = Json::array({to_json((*body.edge)[0]), to_json((*body.edge)[1])});
  }
  return {{"simplified",
           {{"stable", body.is_stable},
            {"margin_mm", or_null(body.margin_mm)},
            {"edge_mm", edge},
            {"centre_of_mass_mm", to_json(body.centre_of_mass)}}},
          {"model",
           {{"stable", assessment.model.is_settled ? Json(assessment.model.is_stable) : Json()},
            {"settled", assessment.model.is_settled}}},
          {"stable", assessment.is_stable}};
}

Json range_json(const verdict::LoadRange& range) { return Json::array({range.low, range.high}); }

Json overload_json(const model::Robot& robot, const verdict::Assessment& assessment) {
  Json broken = Json::array();
  for (const std::size_t connection : assessment.broken) {
    broken.push_back(ends_json(robot, connection));
  }
  Json range;
  if (assessment.load_ratio_max) {
    range = range_json(assessment.load_ratio_range);
  }
  return {{"meaningful", assessment.is_stable && assessment.load_ratio_max.has_value()},
          {"load_ratio_max", or_null(assessment.load_ratio_max)},
          {"load_ratio_range", range},
          {"at", assessment.worst ? ends_json(robot, *assessment.worst) : Json()},
          {"broken", broken},
          {"weight_factor", or_null(assessment.weight_factor)}};
}

Json connections_json(const model::Robot& robot, const verdict::Assessment& assessment) {
  Json list = Json::array();
  for (std::size_t i = 0; i < assessment.connections.size(); ++i) {
    const verdict::ConnectionResult& result = assessment.connections[i];
    const auto [a, b] = model::ends(robot, i);
    list.push_back({{"a", to_json(a)},
                    {"b", to_json(b)},
                    {"load_ratio", result.load_ratio},
                    {"axial_n", result.axial_n},
                    {"bending_nmm", result.bending_nmm},
                    {"shear_n", result.shear_n},
                    {"torsion_nmm", result.torsion_nmm}});
  }
  return list;
}

Json several_json(const verdict::Assessment& assessment) {
  if (!assessment.several) {
    return {};
  }
  const verdict::SeveralSolutions& several = *assessment.several;
  return {{"found", several.found_count},
          {"regularised", range_json(several.regularised)},
          {"unilateral", several.unilateral ? range_json(*several.unilateral) : Json()}};
}

const char* solver_name(const solver::Equilibrium& equilibrium) {
  if (equilibrium.method != solver::Method::kMultigrid) {
    return "sparse direct, 6x6 block LU";
  }
  return equilibrium.precision == solver::Precision::kSingle
             ? "conjugate gradients with multigrid"
             : "conjugate gradients with multigrid in double precision";
}

Json proof_json(const ReportEntry& entry) {
  const certificate::Verification& found = entry.proof->verification;
  return {{"proved", found.is_proved},
          {"load_ratio_range",
           found.is_proved ? Json::array({found.ratio_low, found.ratio_high}) : Json()},
          {"reason", found.is_proved ? Json() : Json(found.reason)},
          {"solves", entry.proof->solve_count},
          {"seconds", entry.proof_seconds}};
}

}  // namespace

std::string write_report_json(const ReportEntry& entry) {
  const model::Robot& robot = *entry.robot;
  const verdict::Assessment& assessment = *entry.assessment;
  Json report = {
      {"name", entry.name},
      {"verdict", verdict::name(assessment.verdict)},
      {"reasons", assessment.reasons},
      {"modules",
       {{"existing", robot.modules().size() - robot.planned_count()},
        {"planned", robot.planned_count()},
        {"on_ground", robot.ground_count()},
        {"fixed", robot.fixed_count()}}},
      {"stability", stability_json(assessment)},
      {"overload", overload_json(robot, assessment)},
      {"connections", connections_json(robot, assessment)},
      {"contact_model", verdict::name(assessment.contact_model)},
      {"several_solutions", several_json(assessment)},
      {"solver",
       {{"name", solver_name(assessment.equilibrium)},
        {"iterations", assessment.equilibrium.steps},
        {"multigrid_iterations", assessment.equilibrium.iteration_count},
        {"seconds", entry.seconds}}},
      {"warnings", std::vector<std::string>(entry.warnings.begin(), entry.warnings.end())}};
  if (entry.proof != nullptr) {
    report["proof"] = proof_json(entry);
  }
  return report.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string write_error_json(const base::Error& error, std::string_view name) {
  const Json report = {{"name", name}, {"error", error.message}, {"where", error.where}};
  return report.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace holdfast::io
