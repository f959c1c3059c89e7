// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "check_options.hpp"
#include "common.hpp"
#include "holdfast/move.hpp"
#include "holdfast/order.hpp"
#include "holdfast/steps.hpp"
#include "holdfast/trial.hpp"
#include "long_work.hpp"
#include "plan_failures_wish.hpp"

/// Adds what may come next: places, steps, orders, moves.
namespace holdfast::python {
namespace {

/// An answer together with what it was asked of.
struct Places {
  SharedStructure structure;
  NextResult result;
};

struct JudgedSteps {
  StepsFile file;
  StepsResult result;
  PlanFailuresReport failures = {};
};

struct FoundOrder : io::OrderReport {
  PlanFailuresReport failures = {};
};

struct FoundMoves : io::MoveReport {
  PlanFailuresReport failures = {};
};

/// A judgement as numpy has it: not a number where nothing is known.
struct JudgementRow {
  std::int32_t cell[3];
  std::uint8_t verdict;
  double load_ratio_max;
  double margin_mm;
};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

py::array rows_of(const std::vector<JudgementRow>& rows, bool has_cells) {
  const Field cell{"cell", "(3,)i4", offsetof(JudgementRow, cell)};
  const Field verdict{"verdict", "u1", offsetof(JudgementRow, verdict)};
  const Field ratio{"load_ratio_max", "f8", offsetof(JudgementRow, load_ratio_max)};
  const Field margin{"margin_mm", "f8", offsetof(JudgementRow, margin_mm)};
  const py::dtype type = has_cells ? record({cell, verdict, ratio, margin}, sizeof(JudgementRow))
                                   : record({verdict, ratio, margin}, sizeof(JudgementRow));
  return {type, {static_cast<py::ssize_t>(rows.size())}, rows.data()};
}

template <class Judged>
JudgementRow row_of(const Judged& judged) {
  return {.cell = {},
          .verdict = static_cast<std::uint8_t>(judged.verdict),
          .load_ratio_max = judged.load_ratio_max.value_or(kNone),
          .margin_mm = judged.margin_mm.value_or(kNone)};
}

/// The row without a load ratio that is only a bound.
JudgementRow solved_row_of(const plan::Judgement& judged) {
  JudgementRow row = row_of(judged);
  row.load_ratio_max = judged.is_bound ? kNone : row.load_ratio_max;
  return row;
}

template <class Judged>
JudgementRow row_at(const base::Cell& cell, const Judged& judged) {
  JudgementRow row = row_of(judged);
  row.cell[0] = cell.x;
  row.cell[1] = cell.y;
  row.cell[2] = cell.z;
  return row;
}

double seconds_of(const py::handle& given, const char* what) {
  return number_of(given, what, 0, std::numeric_limits<double>::infinity());
}

std::shared_ptr<Places> next(const SharedStructure& structure, const py::handle& threads,
                             const py::handle& memory, bool is_bonded, bool is_exact,
                             const py::handle& seconds, const py::dict& asked,
                             py::object progress) {
  expect_one_piece(*structure, "next()");
  Watch watch(std::move(progress));
  NextOptions options{.check = check_options(threads, memory, is_bonded),
                      .is_exact = is_exact,
                      .seconds_max = seconds_of(seconds, "seconds")};
  options.progress = [&](std::size_t done, std::size_t count) { watch(done, count); };
  const PlanFailuresWish wish = plan_failures_wish(asked, options.check);
  auto places = std::make_shared<Places>(structure, NextResult{});
  NextResult& result = places->result;
  const auto error = without_gil(watch, [&] {
    result = find_next(*structure, options);
    const NextFailuresLimits limits{.seconds_max = options.seconds_max - result.seconds};
    return wish.is_wanted() ? find_next_failures(*structure, wish, limits, result) : std::nullopt;
  });
  take(error, {});
  return places;
}

/// The probabilities that candidates hold, or no number, and the losses that bring them down, or
/// None.
py::tuple place_failures(const Places& places) {
  py::list probabilities;
  py::list losses;
  for (const Trial& trial : places.result.candidates) {
    probabilities.append(trial.failures.probability_holds.value_or(kNone));
    losses.append(trial.failures.fatal_loss.empty() ? py::object(py::none())
                                                    : py::str(trial.failures.fatal_loss));
  }
  return py::make_tuple(probabilities, losses);
}

py::array candidates(const Places& places) {
  std::vector<JudgementRow> rows;
  for (const Trial& trial : places.result.candidates) {
    rows.push_back(row_at(trial.cell, trial));
  }
  return rows_of(rows, true);
}

/// Returns by kind the changes that do and how many were judged, and the factor of strength.
py::dict remedies(const SharedCheck& check, const py::handle& threads, const py::handle& memory,
                  bool is_bonded, py::object progress) {
  expect_one_piece(*check->structure, "remedies()");
  const CheckOptions options = check_options(threads, memory, is_bonded);
  Watch watch(std::move(progress));
  const plan::Remedies found = without_gil(watch, [&] {
    return find_remedies(*check->structure, check->result, options,
                         [&](std::size_t done, std::size_t count) { watch(done, count); });
  });
  py::dict out;
  for (std::size_t k = 0; k < plan::kRemedyKindCount; ++k) {
    const plan::RemedyList& list = found.lists[k];
    std::vector<JudgementRow> rows;
    for (const plan::Remedy& remedy : list.safe) {
      rows.push_back(row_at(remedy.cell, remedy.judgement));
    }
    const std::string kind(plan::name(static_cast<plan::RemedyKind>(k)));
    out[py::str(kind)] = py::make_tuple(rows_of(rows, true), list.tried_count);
  }
  out["strength_factor"] = found.strength_factor;
  return out;
}

std::shared_ptr<JudgedSteps> steps(const SharedStructure& structure, const py::handle& threads,
                                   const py::handle& memory, bool ends_when_unsafe, bool is_exact,
                                   const std::string& motions, const py::dict& asked,
                                   py::object progress) {
  const CheckOptions check = check_options(threads, memory, false);
  const std::size_t count = io::step_count(structure->document);
  if (count == 0) {
    throw Error("the structure has no steps; check() judges it as it is");
  }
  Watch watch(std::move(progress));
  StepsOptions options{.thread_count = check.thread_count,
                       .memory_bytes_max = check.memory_bytes_max,
                       .ends_when_unsafe = ends_when_unsafe,
                       .is_exact = is_exact,
                       .progress = [&](std::size_t judged_count) { watch(judged_count, count); }};
  auto judged = std::make_shared<JudgedSteps>(StepsFile{.name = structure->name,
                                                        .document = structure->document,
                                                        .warnings = {},
                                                        .origin = structure->origin},
                                              StepsResult{});
  const PlanFailuresWish wish = plan_failures_wish(asked, check);
  if (!motions.empty()) {
    options.motions = take(find_motions(motions));
  }
  judged->result = take(without_gil(watch, [&] { return judge_steps(judged->file, options); }));
  judged->failures =
      take(without_gil(watch, [&] { return report_plan_failures(judged->file.document, wish); }));
  return judged;
}

/// The stages as an array (steps, 3): release, shift, connect.
py::array stages(const JudgedSteps& judged) {
  std::vector<JudgementRow> rows;
  for (const plan::StepJudgement& step : judged.result.judgement.steps) {
    for (const plan::StageJudgement& stage : step.stages) {
      rows.push_back(solved_row_of(stage));
    }
  }
  return rows_of(rows, false).attr("reshape")(-1, 3);
}

std::optional<std::pair<std::size_t, int>> place_of(const std::optional<plan::StageId>& id) {
  return id ? std::optional(std::pair(id->step, static_cast<int>(id->stage))) : std::nullopt;
}

/// The start with an order as its steps.
io::Document order_document(const FoundOrder& report) {
  return take(io::order_steps(report.target, report.result.order, report.is_reversed));
}

/// How many modules come at a time: a number from 1, or "all".
std::size_t parallel_of(const py::handle& given) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  if (!py::isinstance<py::str>(given)) {
    return integer_of(given, "parallel", 1, 1'000'000'000);
  }
  const std::string word = utf8_of(given, "parallel");
  if (word != "all") {
    throw Error("parallel: expected a number of modules, or all, found '" + word + "'");
  }
  return kAll;
}

/// A box of one cell for each of the cells; none where none is given.
std::vector<plan::CellBox> boxes_of(const py::handle& given, const char* what) {
  std::vector<plan::CellBox> boxes;
  for (const base::Cell& cell :
       given.is_none() ? std::vector<base::Cell>() : cells_of(given, what)) {
    boxes.push_back(plan::box_between(cell, cell));
  }
  return boxes;
}

std::optional<std::size_t> done_count_of(const py::handle& given) {
  return given.is_none() ? std::optional<std::size_t>() : integer_of(given, "at", 0, 1'000'000'000);
}

/// What modules an order begins with and keeps, and how others get to their cells.
void take_ways(const py::handle& start, const py::dict& ways, OrderRequest& request) {
  if (!start.is_none()) {
    request.start = cells_of(start, "start");
  }
  const std::string reach = utf8_of(ways["reach"], "reach");
  request.rule.reach = reach == "line"      ? plan::Reach::kLine
                       : reach == "surface" ? plan::Reach::kSurface
                                            : plan::Reach::kFree;
  if (reach != plan::name(request.rule.reach)) {
    throw Error("reach: expected free, line or surface, found '" + reach + "'");
  }
  if (!ways["source"].is_none()) {
    request.rule.source = cell_of(ways["source"], "source");
  }
  if (!ways["avoid"].is_none()) {
    request.rule.avoid = cells_of(ways["avoid"], "avoid");
  }
  request.keep = boxes_of(ways["keep"], "keep");
  if ((reach == "surface") != request.rule.source.has_value()) {
    throw Error("reach 'surface' and source belong together");
  }
}

/// How many modules come at a time, and in how many pieces.
void take_groups(const py::handle& group, const py::handle& parallel, bool in_pieces,
                 OrderRequest& request) {
  request.group_size = integer_of(group, "group", 1, 16);
  request.parallel_max = parallel_of(parallel);
  if (request.group_size > 1 && request.parallel_max > 1) {
    throw Error("group and parallel exclude each other");
  }
  request.in_pieces = in_pieces;
}

/// `old`: a plan that is gone on with, or none; `on_step` is called with each line of JSON of a
/// step.
std::shared_ptr<FoundOrder> order(const Structure& target, const py::handle& start,
                                  const SharedStructure& old, const py::handle& at,
                                  const py::dict& ways, const py::handle& group,
                                  const py::handle& parallel, bool in_pieces, bool is_reversed,
                                  bool is_exact, const py::handle& seed, const py::handle& seconds,
                                  const py::handle& help_seconds, const py::handle& threads,
                                  const py::dict& asked, py::object progress, py::object on_step) {
  Watch watch(std::move(progress));
  OrderRequest request;
  take_groups(group, parallel, in_pieces, request);
  request.is_reversed = is_reversed;
  request.seed = seed_of(seed);
  request.seconds_max = seconds_of(seconds, "seconds");
  request.help_seconds_max = seconds_of(help_seconds, "help_seconds");
  request.is_exact = is_exact;
  request.thread_count = thread_count_of(threads);
  take_ways(start, ways, request);
  request.progress = [&](std::size_t states, std::size_t grown, std::size_t shrunk) {
    watch(states, grown, shrunk);
  };
  const bool is_listening = !on_step.is_none();
  Watch listener(std::move(on_step));
  if (is_listening) {
    request.stream = [&](const std::string& line) { listener.tell(line); };
  }
  const std::optional<std::size_t> done_count = done_count_of(at);
  const PlanFailuresWish wish = plan_failures_wish(asked, {.thread_count = request.thread_count});
  auto found = std::make_shared<FoundOrder>(FoundOrder{take(without_gil(watch, [&] {
    return old ? continue_order(target.document, old->document, done_count, request)
               : seek_order(target.document, request);
  }))});
  if (found->result.order.outcome == plan::OrderOutcome::kFound && wish.is_wanted()) {
    const io::Document steps = order_document(*found);
    found->failures = take(without_gil(watch, [&] { return report_plan_failures(steps, wish); }));
  }
  return found;
}

/// Cells of the target's modules.
py::array cells_in(const FoundOrder& report, const auto& elements) {
  std::vector<base::Cell> cells;
  for (const auto element : elements) {
    cells.push_back(report.task.target.existing[static_cast<std::size_t>(element)]);
  }
  return array_of(cells);
}

/// The batches as they are attached, or as they are detached where the robot is taken apart.
py::list order_batches(const FoundOrder& report) {
  py::list out;
  for (const plan::Batch& batch : report.result.order.steps) {
    out.append(cells_in(report, batch));
  }
  if (report.is_reversed) {
    out.attr("reverse")();
  }
  return out;
}

py::array order_judgements(const FoundOrder& report) {
  std::vector<JudgementRow> rows;
  for (const plan::Judgement& judgement : report.result.order.judgements) {
    rows.push_back(solved_row_of(judgement));
  }
  if (report.is_reversed) {
    std::ranges::reverse(rows);
  }
  return rows_of(rows, false);
}

SharedStructure order_as_steps(const FoundOrder& report) {
  const plan::Order& order = report.result.order;
  if (order.outcome != plan::OrderOutcome::kFound && order.steps.empty()) {
    throw Error("no order was found");
  }
  return std::make_shared<const Structure>(take(make_structure(order_document(report))));
}

std::string order_certificate(const FoundOrder& report) {
  if (!report.result.certificate) {
    throw Error("there is no certificate, as it was not proved that there is no order");
  }
  return io::write_order_certificate(report.target, *report.result.certificate);
}

py::object order_help(const FoundOrder& report) {
  if (!report.help) {
    return py::none();
  }
  py::dict out;
  out["supports"] = array_of(report.help->supports);
  out["temporary"] = array_of(report.help->temporary);
  const auto& rule = report.help->rule;
  out["reach"] = rule ? py::cast(std::string(plan::name(rule->reach))) : py::none();
  out["source"] =
      array_of(rule && rule->source ? std::vector{*rule->source} : std::vector<base::Cell>{});
  out["pieces"] = report.help->in_pieces;
  return out;
}

std::optional<plan::CellBox> box_of(const py::handle& given) {
  if (given.is_none()) {
    return std::nullopt;
  }
  const auto corners = cells_of(given, "within");
  if (corners.size() != 2) {
    throw Error("within: expected two cells, the corners of a box");
  }
  return plan::box_between(corners[0], corners[1]);
}

/// `end`: the target, or a plan that is gone on with.
std::shared_ptr<FoundMoves> move(const Structure& start, const Structure& end, bool is_continued,
                                 const py::handle& at, const std::string& motions,
                                 const py::dict& ways, bool ignores_mechanics,
                                 const py::handle& seed, const py::handle& seconds,
                                 const py::handle& threads, const py::dict& asked,
                                 py::object progress) {
  Watch watch(std::move(progress));
  MoveRequest request{.within = box_of(ways["within"]),
                      .ignores_mechanics = ignores_mechanics,
                      .keep = boxes_of(ways["keep"], "keep"),
                      .seed = seed_of(seed),
                      .seconds_max = seconds_of(seconds, "seconds"),
                      .thread_count = thread_count_of(threads)};
  if (!ways["avoid"].is_none()) {
    request.avoid = cells_of(ways["avoid"], "avoid");
  }
  if (!motions.empty()) {
    request.motions = take(find_motions(motions));
  }
  request.progress = [&](std::size_t states, int distance) { watch(states, distance); };
  const std::optional<std::size_t> done_count = done_count_of(at);
  const PlanFailuresWish wish = plan_failures_wish(asked, {.thread_count = request.thread_count});
  auto found = std::make_shared<FoundMoves>(FoundMoves{take(without_gil(watch, [&] {
    return is_continued ? continue_moves(start.document, end.document, done_count, request)
                        : seek_moves(start.document, end.document, request);
  }))});
  if (found->plan.outcome == plan::MoveOutcome::kFound) {
    found->failures = take(
        without_gil(watch, [&] { return report_plan_failures(io::move_steps(*found), wish); }));
  }
  return found;
}

/// The moves of every step, each as from, to, and carrier or None.
py::list move_steps(const FoundMoves& report) {
  const auto triple = [](const base::Cell& cell) { return py::make_tuple(cell.x, cell.y, cell.z); };
  py::list out;
  for (const model::Step& step : report.plan.steps) {
    py::list moves;
    for (const model::Move& one : step.moves) {
      moves.append(py::make_tuple(triple(one.from), triple(one.to),
                                  one.carrier ? py::object(triple(*one.carrier)) : py::none()));
    }
    out.append(moves);
  }
  return out;
}

SharedStructure move_as_steps(const FoundMoves& report) {
  return std::make_shared<const Structure>(take(make_structure(io::move_steps(report))));
}

template <class Write>
std::string written_text(const Write& write) {
  return without_gil([&] {
    std::ostringstream out;
    write(out);
    return std::move(out).str();
  });
}

void add_places(py::module_& module) {
  py::class_<Places, std::shared_ptr<Places>>(module, "Places")
      .def_property_readonly("structure", [](const Places& p) { return p.structure; })
      .def_property_readonly("candidates", &candidates)
      .def_property_readonly("failures", &place_failures)
      .def_property_readonly("check_count", [](const Places& p) { return p.result.check_count; })
      .def_property_readonly("open_count", [](const Places& p) { return p.result.open_count; })
      .def_property_readonly("seconds", [](const Places& p) { return p.result.seconds; })
      .def("json",
           [](const Places& p) {
             return written_text(
                 [&](std::ostream& out) { write_next_json(out, *p.structure, p.result); });
           })
      .def("csv", [](const Places& p) { return next_csv(p.result); })
      .def("html",
           [](const Places& p) {
             return without_gil(
                 [&] { return next_html(*p.structure, check(*p.structure), p.result); });
           })
      .def("text", [](const Places& p) { return next_text(*p.structure, p.result); })
      .def("svg", [](const Places& p, const io::FigureOptions& figure) {
        return without_gil(
            [&] { return next_svg(*p.structure, check(*p.structure), p.result, {}, figure); });
      });
  module.def("next", &next);
  module.def("remedies", &remedies);
}

void add_steps(py::module_& module) {
  py::class_<JudgedSteps, std::shared_ptr<JudgedSteps>>(module, "Steps")
      .def_property_readonly(
          "verdict",
          [](const JudgedSteps& s) { return static_cast<int>(s.result.judgement.verdict()); })
      .def_property_readonly("stages", &stages)
      .def_property_readonly(
          "first_unsafe",
          [](const JudgedSteps& s) { return place_of(s.result.judgement.first_unsafe); })
      .def_property_readonly(
          "first_undecided",
          [](const JudgedSteps& s) { return place_of(s.result.judgement.first_undecided); })
      .def_property_readonly("load_ratio_max",
                             [](const JudgedSteps& s) { return s.result.judgement.load_ratio_max; })
      .def_property_readonly(
          "load_ratio_bound",
          [](const JudgedSteps& s) { return s.result.judgement.load_ratio_bound; })
      .def_property_readonly("margin_min_mm",
                             [](const JudgedSteps& s) { return s.result.judgement.margin_min_mm; })
      .def_property_readonly("seconds", [](const JudgedSteps& s) { return s.result.seconds; })
      .def("json",
           [](const JudgedSteps& s) {
             return written_text([&](std::ostream& out) {
               write_steps_json(out, s.file, s.result, s.failures.members);
             });
           })
      .def("text",
           [](const JudgedSteps& s) { return steps_text(s.file, s.result) + s.failures.text; })
      .def_property_readonly("failures",
                             [](const JudgedSteps& s) { return s.failures.member_text; })
      .def("svg",
           [](const JudgedSteps& s, const io::FigureOptions& figure) {
             return steps_svg(s.file, s.result, figure);
           })
      .def("state_svg",
           [](const JudgedSteps& s, std::optional<std::size_t> step,
              const io::FigureOptions& figure) {
             return take(without_gil([&] { return step_svg(s.file, s.result, step, figure); }));
           })
      .def("strip_svg",
           [](const JudgedSteps& s, const io::FigureOptions& figure) {
             return take(without_gil([&] { return steps_strip_svg(s.file, s.result, figure); }));
           })
      .def("csv", [](const JudgedSteps& s) { return steps_csv(s.file, s.result); })
      .def("html",
           [](const JudgedSteps& s) {
             return without_gil([&] { return steps_html(s.file, s.result); });
           })
      .def("save_vtk", [](const JudgedSteps& s, const py::handle& given) {
        const std::string path = path_of(given);
        expect_ending(path, "pvd");
        take(without_gil([&] { return write_steps_vtk(path, s.file, s.result); }), path);
      });
  module.def("steps", &steps);
}

void add_order(py::module_& module) {
  py::class_<FoundOrder, std::shared_ptr<FoundOrder>>(module, "Order")
      .def_property_readonly("outcome",
                             [](const FoundOrder& r) { return io::name(r.result.order.outcome); })
      .def_property_readonly(
          "start", [](const FoundOrder& r) { return cells_in(r, r.result.order.start.elements()); })
      .def_property_readonly("batches", &order_batches)
      .def_property_readonly("judgements", &order_judgements)
      .def_property_readonly("state_count",
                             [](const FoundOrder& r) { return r.result.order.state_count; })
      .def_property_readonly("load_ratio_max",
                             [](const FoundOrder& r) { return r.result.load_ratio_max; })
      .def_property_readonly("load_ratio_bound",
                             [](const FoundOrder& r) { return r.result.load_ratio_bound; })
      .def_property_readonly("steps_least",
                             [](const FoundOrder& r) { return r.result.step_count_least; })
      .def_property_readonly("margin_min_mm",
                             [](const FoundOrder& r) { return r.result.margin_min_mm; })
      .def_property_readonly("seconds", [](const FoundOrder& r) { return r.seconds; })
      .def_property_readonly("help", &order_help)
      .def_property_readonly("kept_count", [](const FoundOrder& r) { return r.kept_count; })
      .def("as_steps", &order_as_steps)
      .def("certificate", &order_certificate)
      .def("json", [](const FoundOrder& r) { return io::order_json(r, r.failures.member_list()); })
      .def("csv", [](const FoundOrder& r) { return io::order_csv(r); })
      .def("html",
           [](const FoundOrder& r) {
             return without_gil([&] { return order_html(r, r.failures.text); });
           })
      .def("text", [](const FoundOrder& r) { return io::order_text(r) + r.failures.text; })
      .def_property_readonly("failures",
                             [](const FoundOrder& r) { return r.failures.member_text; });
  module.def("order", &order);
}

void add_move(py::module_& module) {
  py::class_<FoundMoves, std::shared_ptr<FoundMoves>>(module, "Moves")
      .def_property_readonly("outcome",
                             [](const FoundMoves& r) { return plan::name(r.plan.outcome); })
      .def_property_readonly("steps", &move_steps)
      .def_property_readonly("is_shortest", [](const FoundMoves& r) { return r.plan.is_shortest; })
      .def_property_readonly("length_min", [](const FoundMoves& r) { return r.plan.length_min; })
      .def_property_readonly("assignment_bound",
                             [](const FoundMoves& r) { return r.plan.assignment_bound; })
      .def_property_readonly("state_count", [](const FoundMoves& r) { return r.plan.state_count; })
      .def_property_readonly("seconds", [](const FoundMoves& r) { return r.seconds; })
      .def_property_readonly("kept_count", [](const FoundMoves& r) { return r.kept_count; })
      .def("lines", [](const FoundMoves& r) { return io::move_lines(r); })
      .def("as_steps", &move_as_steps)
      .def("json", [](const FoundMoves& r) { return io::move_json(r, r.failures.member_list()); })
      .def("csv", [](const FoundMoves& r) { return io::move_csv(r); })
      .def("html",
           [](const FoundMoves& r) {
             return without_gil([&] { return move_html(r, r.failures.text); });
           })
      .def("text", [](const FoundMoves& r) { return io::move_text(r) + r.failures.text; })
      .def_property_readonly("failures",
                             [](const FoundMoves& r) { return r.failures.member_text; });
  module.def("move", &move);
}

}  // namespace

void add_plans(py::module_& module) {
  add_places(module);
  add_steps(module);
  add_order(module);
  add_move(module);
}

}  // namespace holdfast::python
