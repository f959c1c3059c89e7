// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The page's core: holdfast's facade behind a few functions of bytes and numbers. Every call reads
// the buffer that holdfast_input() hands out and leaves one reply: a text of JSON, integers and
// numbers, valid until the next call. src/core/wasm.ts is the other side.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "falling_reply.hpp"
#include "holdfast/distributed.hpp"
#include "holdfast/losses.hpp"
#include "holdfast/order.hpp"
#include "holdfast/reliability.hpp"
#include "holdfast/steps.hpp"
#include "insight.hpp"
#include "packet_log.hpp"
#include "request.hpp"
#include "sequence_view.hpp"
#include "vocabulary.hpp"

#define HOLDFAST_EXPORT(name) extern "C" __attribute__((export_name(#name))) auto name

namespace holdfast::web {
namespace {

using Json = nlohmann::ordered_json;

// One program, one caller, one call at a time.
std::vector<std::uint8_t> input;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
Reply reply;                      // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
/// The sequence that was judged last.
std::optional<SequenceView> sequence;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

/// The trials of the robot and role that were tried last.
struct KeptTrials {
  std::vector<std::uint8_t> asked;  ///< The request without its cells.
  CellTrials trials;
};

std::optional<KeptTrials>
    kept_trials;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Reply failure(const base::Error& error) {
  return {.text = dump({{"error", {{"message", error.message}, {"where", error.where}}}}),
          .integers = {},
          .numbers = {}};
}

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Json point_json(const verdict::PlanPoint& point) { return Json::array({point.x, point.y}); }

template <class Number>
Json optional_json(const std::optional<Number>& number) {
  return number ? Json(*number) : Json();
}

Json vector_json(const std::array<double, 3>& vector) {
  return Json::array({vector[0], vector[1], vector[2]});
}

/// The centre of mass of all modules, mm.
std::array<double, 3> centre_of_mass(const model::Robot& robot) {
  std::array<double, 3> centre{};
  double mass = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const auto node = base::node_place(robot.lattice(), robot.modules()[i].cell);
    mass += robot.mass(i);
    for (std::size_t k = 0; k < 3; ++k) {
      centre[k] += robot.mass(i) * robot.material().pitch_mm * node[k];
    }
  }
  for (double& coordinate : centre) {
    coordinate /= mass;
  }
  return centre;
}

const char* name(verdict::StabilityRule rule) {
  switch (rule) {
    case verdict::StabilityRule::kHeld:
      return "held";
    case verdict::StabilityRule::kPolygon:
      return "polygon";
    case verdict::StabilityRule::kContactForces:
      break;
  }
  return "contact-forces";
}

Json motion_json(const std::optional<limit::Motion>& motion) {
  if (!motion) {
    return {};
  }
  return {{"text", limit::text(*motion)},
          {"velocity", vector_json(motion->velocity)},
          {"angular", vector_json(motion->angular)}};
}

Json rigid_json(const limit::RigidStability& rigid) {
  return {{"answer", limit::name(rigid.answer)},
          {"friction_needed", optional_json(rigid.friction_needed)},
          {"tilt_margin_deg", optional_json(rigid.tilt_margin_deg)},
          {"motion", motion_json(rigid.motion)}};
}

Json stability_json(const model::Robot& robot, const verdict::Assessment& assessment) {
  const verdict::RigidBody& body = assessment.simplified;
  Json polygon = Json::array();
  for (const verdict::PlanPoint& corner : body.polygon) {
    polygon.push_back(point_json(corner));
  }
  Json edge;
  if (body.edge) {
    edge = Json::array({point_json((*body.edge)[0]), point_json((*body.edge)[1])});
  }
  auto centre = centre_of_mass(robot);
  centre[0] = body.centre_of_mass.x;
  centre[1] = body.centre_of_mass.y;
  return {{"rule", name(assessment.stability_rule)},
          {"stable", optional_json(verdict::known_stability(assessment))},
          {"margin_mm", optional_json(body.margin_mm)},
          {"edge", edge},
          {"centre_of_mass", vector_json(centre)},
          {"polygon", polygon},
          {"rigid", rigid_json(assessment.rigid)}};
}

Json reasons_json(const model::Robot& robot, const verdict::Assessment& assessment) {
  Json list = Json::array();
  for (const verdict::Reason& reason : assessment.reasons) {
    list.push_back(io::reason_text(robot, reason));
  }
  return list;
}

/// Integers: module, direction, whether it is bonded, and the code of its contact state, -1 if that
/// is not known. Numbers: with what force it presses, the force along it that acts on the module,
/// and the coefficient of friction, -1 without slip.
void add_facets(const model::Robot& robot, const verdict::Assessment& assessment, Reply& out) {
  const auto& equilibrium = assessment.equilibrium;
  const auto facets = robot.facets();
  const bool is_known = equilibrium.facet_force.size() == facets.size();
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const model::Facet& facet = facets[i];
    const std::int32_t state = is_known ? equilibrium.contact[i].code() : -1;
    out.integers.insert(out.integers.end(), {facet.module, base::index(facet.direction),
                                             facet.is_bonded() ? 1 : 0, state});
    const base::Vec6<double> force = is_known ? equilibrium.facet_force[i] : base::Vec6<double>{};
    const auto normal = base::heading(robot.lattice(), facet.direction);
    const double along = force[0] * normal[0] + force[1] * normal[1] + force[2] * normal[2];
    out.numbers.push_back(-along);
    for (std::size_t k = 0; k < 3; ++k) {
      out.numbers.push_back(force[k] - along * normal[k]);
    }
    out.numbers.push_back(facet.touch.friction.value_or(-1));
  }
}

/// Whether linear theory suffices, in words; null where it was not asked.
Json second_order_json(const verdict::Assessment& assessment) {
  const auto& second = assessment.second_order;
  return second ? Json(fmt::format("{}: {}", io::buckling_text(*second), name(second->trust)))
                : Json();
}

/// The limit that each connection's load ratio is of; nothing where all of them open.
void add_limits(const model::Robot& robot, const verdict::Assessment& assessment, Reply& out) {
  if (robot.has_default_connectors()) {
    return;
  }
  for (const model::Limit limit : connection_limits(robot, assessment)) {
    out.integers.push_back(static_cast<std::int32_t>(limit));
  }
}

/// Integers: connections, broken ones, facets; a, b and direction of each connection; indices of
/// the broken ones; four of each facet; limits of the connections, if they have any but one.
/// Numbers: five of each connection (ConnectionResult), five of each facet, six displacements of
/// each module.
Reply assessment_reply(const model::Robot& robot, const verdict::Assessment& assessment,
                       double seconds) {
  Reply out;
  out.text = dump({{"verdict", verdict::name(assessment.verdict)},
                   {"reasons", reasons_json(robot, assessment)},
                   {"stability", stability_json(robot, assessment)},
                   {"load_ratio_max", optional_json(assessment.load_ratio_max)},
                   {"worst", optional_json(assessment.worst)},
                   {"weight_factor", optional_json(assessment.weight_factor)},
                   {"contact_model", verdict::name(assessment.contact_model)},
                   {"solves", assessment.equilibrium.steps},
                   {"second_order", second_order_json(assessment)},
                   {"facet_half_mm", robot.foot_half_width_mm()},
                   {"has_loads", !assessment.connections.empty()},
                   {"seconds", seconds}});
  const auto connections = robot.connections();
  out.integers = {static_cast<std::int32_t>(connections.size()),
                  static_cast<std::int32_t>(assessment.broken.size()),
                  static_cast<std::int32_t>(robot.facets().size())};
  for (const model::Connection& pair : connections) {
    out.integers.insert(out.integers.end(), {pair.a, pair.b, base::index(pair.direction)});
  }
  for (const std::size_t broken : assessment.broken) {
    out.integers.push_back(static_cast<std::int32_t>(broken));
  }
  for (const verdict::ConnectionResult& result : assessment.connections) {
    out.numbers.insert(out.numbers.end(), {result.load_ratio, result.axial_n, result.bending_nmm,
                                           result.shear_n, result.torsion_nmm});
  }
  add_facets(robot, assessment, out);
  add_limits(robot, assessment, out);
  for (const auto& displacement : assessment.equilibrium.displacement) {
    for (int i = 0; i < 6; ++i) {
      out.numbers.push_back(displacement[static_cast<std::size_t>(i)]);
    }
  }
  return out;
}

base::Result<model::Robot> robot_of(const Request& request) {
  const auto spec = spec_of(request);
  return spec ? model::Robot::create(spec.value()) : base::Result<model::Robot>(spec.error());
}

Reply check_request(const Request& request) {
  const auto robot = robot_of(request);
  if (!robot) {
    return failure(robot.error());
  }
  const bool is_first_look = request.header.options[0] != 0;
  if (is_first_look) {
    return assessment_reply(robot.value(), first_look(robot.value()), 0);
  }
  const CheckResult result = check(robot.value());
  return assessment_reply(robot.value(), result.assessment, result.seconds);
}

/// Text: what io::collapse_json says; null also if it is not found within options[0] seconds.
Reply limit_request(const Request& request) {
  const auto robot = robot_of(request);
  if (!robot) {
    return failure(robot.error());
  }
  const CheckResult result =
      check(robot.value(), {.is_limit_wanted = true,
                            .limit_seconds_max = static_cast<double>(request.header.options[0])});
  return {.text = io::collapse_json(robot.value(), *result.limit), .integers = {}, .numbers = {}};
}

/// The factor of all loads that options[0] gives in thousandths: of gravity and payloads.
void scale_loads(model::RobotSpec& spec, double factor) {
  auto gravity =
      spec.gravity_m_s2.value_or(std::array<double, 3>{0, 0, -spec.material.gravity_m_s2});
  for (double& component : gravity) {
    component *= factor;
  }
  spec.gravity_m_s2 = gravity;
  for (model::Payload& payload : spec.payloads) {
    for (std::size_t k = 0; k < 3; ++k) {
      payload.force_n[k] *= factor;
      payload.torque_nmm[k] *= factor;
    }
  }
}

/// The reply of a check in the deformed shape, under options[0] thousandths of all loads. Its text
/// has "factor" besides: the share of these loads up to which a stable equilibrium was followed.
Reply deformed_request(const Request& request) {
  auto read = spec_of(request);
  if (!read) {
    return failure(read.error());
  }
  model::RobotSpec spec = std::move(read).value();
  scale_loads(spec, request.header.options[0] / 1000.0);
  const auto robot = model::Robot::create(spec);
  if (!robot) {
    return failure(robot.error());
  }
  const CheckResult result = check(
      robot.value(), {.is_deformed_wanted = true, .factor_max = 1, .obstacles = spec.obstacles});
  Reply out = assessment_reply(robot.value(), result.assessment, result.deformed_seconds);
  Json text = Json::parse(out.text);
  text["factor"] = result.deformed ? Json(result.deformed->last.factor) : Json();
  out.text = dump(text);
  return out;
}

/// Text: what report_text() says of the probability that every connection holds, where each
/// strength scatters by options[0] thousandths, all together by options[1] and each mass by
/// options[2], and that as a number, null where it is not known.
Reply reliability_request(const Request& request) {
  const auto spec = spec_of(request);
  const auto robot = robot_of(request);
  if (!robot) {
    return failure(robot.error());
  }
  verdict::StrengthScatter scatter{.cv = request.header.options[0] / 1000.0,
                                   .common_cv = request.header.options[1] / 1000.0};
  if (request.header.options[2] > 0) {
    scatter.mass_cv.assign(robot.value().modules().size(), request.header.options[2] / 1000.0);
  }
  const CheckResult result = check(robot.value());
  const auto found = find_reliability(
      AssessedRobot{.robot = robot.value(), .assessment = result.assessment, .spec = &spec.value()},
      scatter, {.thread_count = 1});
  return {.text = dump({{"holds", found ? Json(found->holds) : Json()},
                        {"fails", found ? Json(found->fails) : Json()},
                        {"text", reliability_text(robot.value(), found)}}),
          .integers = {},
          .numbers = {}};
}

/// Text: what follows from the loss of each single part, as holdfast check --lose-one --json says
/// it, and in words. Losses that are not judged within options[0] seconds are undecided.
Reply lose_one_request(const Request& request) {
  const auto spec = spec_of(request);
  const auto robot = robot_of(request);
  if (!robot) {
    return failure(robot.error());
  }
  const plan::LossReport report = plan::lose_each(
      spec.value(), {.equilibrium = {.thread_count = 1},
                     .seconds_max = static_cast<double>(request.header.options[0])});
  std::string text;
  io::JsonStream json(text, io::JsonStream::Layout::kCompact);
  json.begin_object();
  write_lose_one_member(json, robot.value(), report);
  json.member("text", lose_one_text(report));
  json.end_object();
  return {.text = text, .integers = {}, .numbers = {}};
}

/// What follows the break, and how the pieces fall: falling_reply().
Reply cascade_request(const Request& request) {
  const auto spec = spec_of(request);
  const auto robot = robot_of(request);
  if (!robot) {
    return failure(robot.error());
  }
  const auto cascade =
      plan::find_cascade(spec.value(), {.equilibrium = {.thread_count = 1}, .progress = {}});
  return cascade ? falling_reply(spec.value(), robot.value(), cascade.value())
                 : failure(cascade.error());
}

/// Why the worst connection carries what it carries, and single changes with which the robot is
/// safe. Text: the sentences, and "remedies" as in a report, null for a safe robot. Integers: the
/// modules that this connection alone holds.
Reply why_request(const Request& request) {
  const auto spec = spec_of(request);
  const auto robot = robot_of(request);
  if (!robot) {
    return failure(robot.error());
  }
  const verdict::Assessment assessment = check(robot.value()).assessment;
  Reply out;
  io::JsonStream json(out.text, io::JsonStream::Layout::kCompact);
  json.begin_object();
  json.member("why", why_text(robot.value(), assessment));
  if (assessment.verdict != verdict::Verdict::kSafe) {
    write_remedies_member(json, plan::find_remedies(spec.value(), plan::judgement_of(assessment),
                                                    {.equilibrium = {.thread_count = 1}}));
  }
  json.end_object();
  if (assessment.worst && assessment.is_stable) {
    for (const std::size_t module : hanging_modules(robot.value(), *assessment.worst)) {
      out.integers.push_back(static_cast<std::int32_t>(module));
    }
  }
  return out;
}

/// The trials that were prepared for the same robot and role, or else new ones.
base::Result<CellTrials*> trials_for(const Request& request) {
  const auto size = static_cast<std::size_t>(request.tail.data() - input.data());
  const std::span asked = std::span(input).first(size);
  if (!kept_trials || !std::ranges::equal(kept_trials->asked, asked)) {
    kept_trials.reset();
    auto spec = spec_of(request);
    if (!spec) {
      return spec.error();
    }
    const auto role = static_cast<Role>(request.header.options[0]);
    kept_trials.emplace(KeptTrials{.asked = {asked.begin(), asked.end()},
                                   .trials = CellTrials(std::move(spec).value(), role)});
  }
  return &kept_trials->trials;
}

/// Tries one more module of the Role in options[0] at each place of the tail. Text: a list of
/// verdicts, null where no module can be. Numbers: the largest load ratio (-1 if there is none) and
/// the margin in mm (0 if it is fixed).
Reply try_places(const Request& request) {
  const auto trials = trials_for(request);
  if (!trials) {
    return failure(trials.error());
  }
  Reply out;
  Json verdicts = Json::array();
  const std::span places(reinterpret_cast<const base::Cell*>(request.tail.data()),
                         request.tail.size() / sizeof(base::Cell));
  for (const Trial& trial : trials.value()->at(places)) {
    verdicts.push_back(trial.is_robot ? Json(verdict::name(trial.verdict)) : Json());
    out.numbers.push_back(trial.load_ratio_max.value_or(-1));
    out.numbers.push_back(trial.margin_mm.value_or(0));
  }
  out.text = dump(verdicts);
  return out;
}

/// Whether a text is in one of the formats that are written too, and are text.
bool is_written(std::string_view text, const std::string& ending) {
  return !text.starts_with(io::kBinaryMagic) && io::find_foreign_format(text, ending) == nullptr;
}

/// Integers: x, y, z and Role of each module. Numbers: the material. Cells that are no robot yet
/// can be opened and mended; cells that the page cannot hold as they are, two modules in one, get
/// the program's error. Before the text stand the ending of the file's name, a blank, the edge of a
/// module in the unit of a mesh, 0 if none is known, and a zero. `base` is
/// the document as JSON where the text is in a format that is read and not written, else empty.
Reply open_text(std::string_view file) {
  const std::size_t zero = file.find('\0');
  HOLDFAST_CHECK(zero != std::string_view::npos);
  const std::size_t blank = file.find(' ');
  const std::string ending(file.substr(0, blank));
  const double pitch = std::strtod(std::string(file.substr(blank, zero - blank)).c_str(), nullptr);
  const std::string_view text = file.substr(zero + 1);
  const auto read = io::read_document(
      text, {.ending = ending, .mesh_pitch = pitch > 0 ? std::optional(pitch) : std::nullopt});
  if (!read) {
    return failure(read.error());
  }
  const io::Document& document = read.value().document;
  if (has_double_cell(document)) {
    const auto robot = io::make_robot(document);
    HOLDFAST_CHECK(!robot);
    return failure(robot.error());
  }
  Reply out;
  out.text = dump({{"name", document.name},
                   {"description", document.description},
                   {"support_z", document.support_z},
                   {"more", more_of(document)},
                   {"base", is_written(text, ending) ? "" : io::write_json(document)},
                   {"later_steps", document.extension.plan.size() +
                                       (document.steps.empty() ? 0 : document.steps.size() - 1)},
                   {"warnings", read.value().warnings}});
  const auto add = [&](const base::Cell& cell, Role role) {
    out.integers.insert(out.integers.end(),
                        {cell.x, cell.y, cell.z, static_cast<std::int32_t>(role)});
  };
  for (const io::ModuleEntry& module : document.modules) {
    add(module.cell, module.is_fixed ? Role::kFixed : Role::kExisting);
  }
  if (!document.steps.empty()) {
    for (const io::PlannedEntry& planned : document.steps.front()) {
      add(planned.cell, Role::kPlanned);
    }
  }
  for (const double number : numbers_of(document.material)) {
    out.numbers.push_back(number);
  }
  return out;
}

enum class Output : std::int32_t { kJson, kXml, kSvg, kReportJson, kReportText };

std::string written(const Structure& structure, Output output) {
  const CheckResult result = check(structure);
  switch (output) {
    case Output::kSvg:
      return picture_svg(structure, result);
    case Output::kReportJson:
      return report_json(structure, result);
    default:
      return fmt::format("{}: {}\n{}", structure.name, verdict::name(result.assessment.verdict),
                         report_text(structure, result));
  }
}

/// The tail: the name in options[1] bytes, then the text of the file that was opened, if any.
base::Result<io::Document> document_of(const Request& request) {
  const auto name_size = static_cast<std::size_t>(request.header.options[1]);
  const std::string_view tail = as_text(request.tail);
  io::Document base;
  if (tail.size() > name_size) {
    auto read = io::read_document(tail.substr(name_size));
    if (!read) {
      return read.error();
    }
    base = std::move(read).value().document;
  }
  auto changed = edited(base, request);
  if (!changed) {
    return changed.error();
  }
  io::Document document = std::move(changed).value();
  document.name = tail.substr(0, name_size);
  return document;
}

/// Text: what options[0] asks for, an Output; not JSON if it is none.
Reply write_document(const Request& request) {
  auto document = document_of(request);
  if (!document) {
    return failure(document.error());
  }
  const auto output = static_cast<Output>(request.header.options[0]);
  if (output == Output::kJson || output == Output::kXml) {
    return {.text = output == Output::kJson ? io::write_json(document.value())
                                            : io::write_visiblesim(document.value()),
            .integers = {},
            .numbers = {}};
  }
  auto robot = io::make_robot(document.value());
  if (!robot) {
    return failure(robot.error());
  }
  const std::string name = document.value().name;
  const Structure structure{.name = name,
                            .document = std::move(document).value(),
                            .robot = std::move(robot).value(),
                            .warnings = {}};
  return {.text = written(structure, output), .integers = {}, .numbers = {}};
}

/// Text: what each step does in words, and the report of holdfast steps --json. Integers: see
/// SequenceView::transitions().
Reply judge_steps_request(const Request& request) {
  sequence.reset();
  auto document = document_of(request);
  if (!document) {
    return failure(document.error());
  }
  const std::string name = document.value().name;
  const StepsFile file{.name = name, .document = std::move(document).value(), .warnings = {}};
  const auto result = judge_steps(file, {.is_exact = true});
  if (!result) {
    return failure(result.error());
  }
  sequence.emplace(io::make_sequence(file.document).value());
  Json texts = Json::array();
  for (std::size_t step = 0; step < io::step_count(file.document); ++step) {
    texts.push_back(io::step_text(file.document, step));
  }
  std::ostringstream report;
  write_steps_json(report, file, result.value());
  return {.text = fmt::format("{{\"texts\":{},\"report\":{}}}", dump(texts), report.str()),
          .integers = sequence->transitions(),
          .numbers = {}};
}

/// The seconds for which help is sought where there is no order.
constexpr double kHelpSeconds = 3;

/// An order for the modules of the document, sought for options[0] seconds. Text: the outcome, the
/// report in words, and the structure with the steps as a file, empty if none was found.
Reply order_request(const Request& request) {
  auto document = document_of(request);
  if (!document) {
    return failure(document.error());
  }
  io::Document target = std::move(document).value();
  target.extension.plan.clear();
  const auto report =
      seek_order(target, {.seconds_max = static_cast<double>(request.header.options[0]),
                          .help_seconds_max = kHelpSeconds,
                          .thread_count = 1});
  if (!report) {
    return failure(report.error());
  }
  const plan::Order& order = report.value().result.order;
  std::string structure;
  if (order.outcome == plan::OrderOutcome::kFound) {
    const auto steps = io::order_steps(report.value().target, order, false);
    if (!steps) {
      return failure(steps.error());
    }
    structure = io::write_json(steps.value());
  }
  return {.text = dump({{"outcome", io::name(order.outcome)},
                        {"text", io::order_text(report.value())},
                        {"structure", structure}}),
          .integers = {},
          .numbers = {}};
}

/// Adds the modules and loads of a piece to a stage_reply().
void add_piece(const model::Robot& robot, const verdict::Assessment& assessment, Reply& cells,
               Reply& loads) {
  const auto offset = static_cast<std::int32_t>(cells.integers.size() / 3);
  for (const model::Module& module : robot.modules()) {
    cells.integers.insert(cells.integers.end(), {module.cell.x, module.cell.y, module.cell.z});
  }
  std::vector<std::int32_t> is_broken(assessment.connections.size());
  for (const std::size_t broken : assessment.broken) {
    is_broken[broken] = 1;
  }
  for (std::size_t i = 0; i < assessment.connections.size(); ++i) {
    const model::Connection& pair = robot.connections()[i];
    const verdict::ConnectionResult& result = assessment.connections[i];
    loads.integers.insert(loads.integers.end(), {pair.a + offset, pair.b + offset,
                                                 base::index(pair.direction), is_broken[i]});
    loads.numbers.insert(loads.numbers.end(),
                         {result.load_ratio, result.axial_n, result.bending_nmm, result.shear_n,
                          result.torsion_nmm});
  }
}

/// A scene of the sequence that was judged last. The bytes are step, stage and waypoint, four of
/// each. Text: list of stabilities of its pieces and the contact model. Integers: modules; x, y, z
/// of each; a, b, direction and whether it is broken of each connection. Numbers: five of each
/// connection.
Reply stage_reply(std::span<const std::uint8_t> bytes) {
  std::array<std::int32_t, 3> place{};
  HOLDFAST_CHECK(sequence.has_value() && bytes.size() == sizeof(place));
  std::memcpy(place.data(), bytes.data(), sizeof(place));
  const auto scene =
      sequence->scene(static_cast<std::size_t>(place[0]), static_cast<plan::Stage>(place[1]),
                      static_cast<std::size_t>(place[2]));
  if (!scene) {
    return failure(scene.error());
  }
  Reply cells;
  Reply loads;
  Json stabilities = Json::array();
  Json contact_model;
  for (const model::RobotSpec& spec : scene.value().pieces) {
    const auto robot = model::Robot::create(spec);
    if (!robot) {
      return failure(robot.error());
    }
    const verdict::Assessment assessment = plan::assess(robot.value());
    stabilities.push_back(stability_json(robot.value(), assessment));
    contact_model = verdict::name(assessment.contact_model);
    add_piece(robot.value(), assessment, cells, loads);
  }
  loads.text = dump({{"stabilities", stabilities}, {"contact_model", contact_model}});
  cells.integers.insert(cells.integers.begin(),
                        static_cast<std::int32_t>(cells.integers.size() / 3));
  cells.integers.insert(cells.integers.end(), loads.integers.begin(), loads.integers.end());
  loads.integers = std::move(cells.integers);
  return loads;
}

/// options: method and line as vocabulary_json() gives them, seed, loss in thousandths, events that
/// are kept in thousands.
sim::SimulationOptions simulation_options(const RequestHeader& header) {
  sim::SimulationOptions options;
  const auto method = static_cast<agent::Method>(header.options[0]);
  if (method != agent::Method::kElimination) {
    options.method = method;  // Else the usual one of its kind of robot.
  }
  options.link = link_of(header.options[1]);
  options.seed = static_cast<std::uint64_t>(header.options[2]);
  options.link.loss = header.options[3] / 1000.0;
  return options;
}

void write_order(io::JsonStream& json, const char* text, bool is_iteration) {
  json.begin_object();
  json.member("text", text);
  json.member("is_iteration", is_iteration);
  json.end_object();
}

/// Writes what a report says of a simulation, and what the page needs besides to play it.
std::string simulation_summary(const DistributedRun& run, bool is_complete) {
  std::string text;
  io::JsonStream json(text, io::JsonStream::Layout::kCompact);
  json.begin_object();
  write_distributed(json, run);
  json.member("root", run.result.root);
  json.member("is_complete", is_complete);
  json.member("ticks_per_second", run.link.ticks_per_second);
  json.key("orders");
  json.begin_array();
  // By number: at numbers that are no operation there is an empty text.
  const auto texts = agent::column(&agent::OperationInfo::text);
  const auto iterations = agent::column(&agent::OperationInfo::is_iteration);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    write_order(json, texts[i] != nullptr ? texts[i] : "", iterations[i]);
  }
  json.end_array();
  json.end_object();
  return text;
}

/// Integers and numbers: the events, see PacketLog.
Reply simulate_request(const Request& request) {
  const auto robot = robot_of(request);
  if (!robot) {
    return failure(robot.error());
  }
  sim::SimulationOptions options = simulation_options(request.header);
  PacketLog log(static_cast<std::size_t>(request.header.options[4]) * 1000);
  options.trace = &log;
  const auto run = simulate(robot.value(), check(robot.value()), options);
  if (!run) {
    return failure(run.error());
  }
  return {.text = simulation_summary(run.value(), log.is_complete()),
          .integers = log.take_integers(),
          .numbers = log.take_numbers()};
}

}  // namespace
}  // namespace holdfast::web

namespace web = holdfast::web;

/// The place for the next request of `size` bytes.
HOLDFAST_EXPORT(holdfast_input)(std::size_t size)->std::uint8_t* {
  web::reply = {};
  web::input.resize(size);
  return web::input.data();
}

HOLDFAST_EXPORT(holdfast_vocabulary)()->void {
  web::reply = {.text = web::vocabulary_json(), .integers = {}, .numbers = {}};
}

HOLDFAST_EXPORT(holdfast_open)()->void { web::reply = web::open_text(web::as_text(web::input)); }

HOLDFAST_EXPORT(holdfast_check)()->void {
  web::reply = web::check_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_limit)()->void {
  web::reply = web::limit_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_why)()->void {
  web::reply = web::why_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_deformed)()->void {
  web::reply = web::deformed_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_reliability)()->void {
  web::reply = web::reliability_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_lose_one)()->void {
  web::reply = web::lose_one_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_cascade)()->void {
  web::reply = web::cascade_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_try_places)()->void {
  web::reply = web::try_places(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_write)()->void {
  web::reply = web::write_document(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_judge_steps)()->void {
  web::reply = web::judge_steps_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_find_order)()->void {
  web::reply = web::order_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_stage)()->void { web::reply = web::stage_reply(web::input); }

HOLDFAST_EXPORT(holdfast_simulate)()->void {
  web::reply = web::simulate_request(web::read_request(web::input));
}

HOLDFAST_EXPORT(holdfast_text)()->const char* { return web::reply.text.data(); }

HOLDFAST_EXPORT(holdfast_text_size)()->std::size_t { return web::reply.text.size(); }

HOLDFAST_EXPORT(holdfast_integers)()->const std::int32_t* { return web::reply.integers.data(); }

HOLDFAST_EXPORT(holdfast_integers_size)()->std::size_t { return web::reply.integers.size(); }

HOLDFAST_EXPORT(holdfast_numbers)()->const double* { return web::reply.numbers.data(); }

HOLDFAST_EXPORT(holdfast_numbers_size)()->std::size_t { return web::reply.numbers.size(); }
