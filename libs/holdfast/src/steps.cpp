// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "holdfast/host/text.hpp"
#include "holdfast/plan/module_moves.hpp"
#include "plan_page.hpp"
#include "series/series_files.hpp"
#include "step_walk.hpp"

namespace holdfast {
namespace {

io::StepsEntry entry_of(const StepsFile& file, const StepsResult& result) {
  return {.origin = file.origin,
          .name = file.name,
          .document = &file.document,
          .judgement = &result.judgement,
          .warnings = file.warnings,
          .seconds = result.seconds};
}

/// The first step with a move that is none of the motions, as judge_steps() says it.
std::optional<base::Error> find_barred_step(const io::Sequence& sequence,
                                            const std::shared_ptr<const plan::Motions>& motions) {
  if (motions->lattice != sequence.start.lattice) {
    return base::bad_input(plan::motions_of_other_lattice(*motions));
  }
  std::size_t step = 0;
  auto error = for_each_step(sequence.start, sequence.steps,
                             [&](const plan::RobotState& robot, const model::Step& each,
                                 const plan::Transition& transition, std::size_t i) {
                               step = i;
                               return plan::find_barred_move(robot, each, transition, motions);
                             });
  if (error) {
    error->message = fmt::format("step {}: {}", step, error->message);
    error->where = std::to_string(step);
  }
  return error;
}

}  // namespace

base::Result<StepsFile> load_steps(const std::filesystem::path& path,
                                   const io::ReadOptions& options) {
  auto read = read_structure(path, options);
  if (!read) {
    return read.error();
  }
  auto [document, warnings] = std::move(read).value();
  if (io::step_count(document) == 0) {
    return base::Error{.code = base::ErrorCode::kBadInput,
                       .message = "the structure has no steps; holdfast check judges it as it is",
                       .where = io::step_list(document)};
  }
  std::string name = document.name.empty() ? path.stem().string() : document.name;
  return StepsFile{.name = std::move(name),
                   .document = std::move(document),
                   .warnings = std::move(warnings),
                   .origin = {.file = path.string()}};
}

base::Result<StepsResult> judge_steps(const StepsFile& file, const StepsOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto sequence = io::make_sequence(file.document);
  if (!sequence) {
    return sequence.error();
  }
  const auto located = [&](base::Error error) {
    if (!error.where.empty()) {
      error.where = io::step_pointer(file.document, std::stoul(error.where));
    }
    return io::with_other_lattice(std::move(error), file.document);
  };
  if (options.motions) {
    if (auto error = find_barred_step(sequence.value(), options.motions)) {
      return located(*std::move(error));
    }
  }
  plan::SequenceOptions more;
  more.ends_when_unsafe = options.ends_when_unsafe;
  if (!options.is_exact) {
    more.solved_count_max = plan::kExactModuleCount;
  }
  more.progress = options.progress;
  more.solver.thread_count = options.thread_count;
  more.solver.memory_bytes_max = options.memory_bytes_max;
  auto judged = plan::judge_sequence(sequence.value().start, sequence.value().steps, more);
  if (!judged) {
    return located(judged.error());
  }
  StepsResult result{.judgement = std::move(judged).value()};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

void write_steps_json(std::ostream& out, const StepsFile& file, const StepsResult& result,
                      const io::MoreKeys& more) {
  io::write_steps_json(out, entry_of(file, result), more);
}

std::string steps_svg(const StepsFile& file, const StepsResult& result,
                      const io::FigureOptions& figure) {
  return io::write_steps_svg(entry_of(file, result), figure);
}

namespace {

/// Calls `visit(state, pieces)` for the start, state 0, and for the robot after each step that was
/// judged, each in its pieces; ends at the first error.
template <class Wanted, class Visit>
std::optional<base::Error> for_each_state(const StepsFile& file, const StepsResult& result,
                                          const Wanted& wanted, const Visit& visit) {
  const auto sequence = io::make_sequence(file.document);
  if (!sequence) {
    return sequence.error();
  }
  if (wanted(0)) {
    if (auto error = visit(0, std::vector<model::RobotSpec>{sequence.value().start})) {
      return error;
    }
  }
  const std::span<const model::Step> steps = sequence.value().steps;
  return for_each_step(
      sequence.value().start, steps.first(result.judgement.steps.size()),
      [&](const plan::RobotState& robot, const model::Step& step,
          const plan::Transition& transition, std::size_t i) -> std::optional<base::Error> {
        if (!wanted(i + 1)) {
          return std::nullopt;
        }
        const auto scenes = plan::find_scenes(robot, step, transition, plan::Stage::kConnect);
        return scenes ? visit(i + 1, scenes.value().front().pieces) : scenes.error();
      });
}

/// A robot that was solved anew, and what it was made of.
struct DrawnState {
  std::size_t step;
  model::RobotSpec spec;
  std::optional<model::Robot> robot = {};
  CheckResult checked = {};
};

/// The states that are wanted, solved.
template <class Wanted>
base::Result<std::vector<DrawnState>> drawn_states(const StepsFile& file, const StepsResult& result,
                                                   const StepsOptions& options,
                                                   const Wanted& wanted) {
  std::vector<DrawnState> states;
  const auto visit =
      [&](std::size_t step,
          const std::vector<model::RobotSpec>& pieces) -> std::optional<base::Error> {
    if (pieces.size() > 1) {
      return base::Error{.code = base::ErrorCode::kBadInput,
                         .message = fmt::format("after step {} the robot is in {}, of which no one "
                                                "picture is made; --vtk writes each",
                                                step - 1, host::counted(pieces.size(), "piece"))};
    }
    auto robot = model::Robot::create(pieces.front(), options.thread_count);
    if (!robot) {
      return robot.error();
    }
    DrawnState state{.step = step, .spec = pieces.front()};
    state.robot.emplace(std::move(robot).value());
    state.checked = check(*state.robot, {.thread_count = options.thread_count,
                                         .memory_bytes_max = options.memory_bytes_max});
    states.push_back(std::move(state));
    return std::nullopt;
  };
  if (const auto error = for_each_state(file, result, wanted, visit)) {
    return *error;
  }
  return states;
}

/// The states in a film strip: all of them, or some evenly spread, the first unsafe and the last.
std::set<std::size_t> strip_states(const plan::SequenceJudgement& judged) {
  const std::size_t count = judged.steps.size();
  const std::size_t intervals = count < kStripFrameMax ? count : kStripFrameMax - 2;
  std::set<std::size_t> states = {count};
  for (std::size_t i = 0; i < intervals; ++i) {
    states.insert(i * count / intervals);
  }
  if (judged.first_unsafe) {
    states.insert(judged.first_unsafe->step + 1);
  }
  return states;
}

}  // namespace

std::optional<base::Error> write_steps_vtk(const std::filesystem::path& path, const StepsFile& file,
                                           const StepsResult& result, const StepsOptions& options) {
  SeriesFiles series(path);
  if (auto fault = series.find_fault()) {
    return fault;
  }
  const auto add = [&](std::size_t time, std::span<const model::RobotSpec> pieces) {
    for (std::size_t part = 0; part < pieces.size(); ++part) {
      const auto robot = model::Robot::create(pieces[part], options.thread_count);
      if (!robot) {
        return std::optional(robot.error());
      }
      const CheckResult checked = check(
          robot.value(),
          {.thread_count = options.thread_count, .memory_bytes_max = options.memory_bytes_max});
      auto error = series.add(time, part, pieces.size(), [&](std::ostream& out) {
        io::write_vtu(out, robot.value(), checked.assessment, {}, pieces[part].obstacles);
      });
      if (error) {
        return error;
      }
    }
    if (options.progress && time > 0) {
      options.progress(time);
    }
    return std::optional<base::Error>();
  };
  const auto error = for_each_state(
      file, result, [](std::size_t) { return true; }, add);
  return error ? error : series.finish();
}

base::Result<std::string> step_svg(const StepsFile& file, const StepsResult& result,
                                   std::optional<std::size_t> step, const io::FigureOptions& figure,
                                   const StepsOptions& options) {
  const std::size_t count = result.judgement.steps.size();
  if (step && *step >= count) {
    return base::Error{.code = base::ErrorCode::kBadInput,
                       .message = fmt::format("expected a step from 0 to {}, or start; found {}",
                                              count - 1, *step)};
  }
  const std::size_t wanted = step ? *step + 1 : 0;
  const auto states =
      drawn_states(file, result, options, [&](std::size_t state) { return state == wanted; });
  if (!states) {
    return states.error();
  }
  const DrawnState& state = states.value().front();
  const std::string title = step ? fmt::format("{}, after step {}", file.name, *step)
                                 : fmt::format("{}, start", file.name);
  return io::write_svg(*state.robot, state.checked.assessment, title, state.spec.obstacles, figure);
}

base::Result<std::string> steps_strip_svg(const StepsFile& file, const StepsResult& result,
                                          const io::FigureOptions& figure,
                                          const StepsOptions& options) {
  const std::set<std::size_t> wanted = strip_states(result.judgement);
  const auto states = drawn_states(file, result, options,
                                   [&](std::size_t state) { return wanted.contains(state); });
  if (!states) {
    return states.error();
  }
  std::vector<io::StripFrame> frames;
  for (const DrawnState& state : states.value()) {
    frames.push_back({.step = state.step,
                      .robot = &*state.robot,
                      .assessment = &state.checked.assessment,
                      .obstacles = state.spec.obstacles});
  }
  return io::write_strip_svg(frames, file.name, figure);
}

std::string steps_html(const StepsFile& file, const StepsResult& result,
                       const StepsOptions& options) {
  const std::string text = steps_text(file, result);
  return io::write_report_page({.command = "steps",
                                .name = file.name,
                                .answer = verdict::name(result.judgement.verdict()),
                                .pictures = steps_pictures(file, result, options),
                                .text = text});
}

std::string steps_text(const StepsFile& file, const StepsResult& result) {
  return io::write_steps_text(entry_of(file, result));
}

std::string steps_csv(const StepsFile& file, const StepsResult& result) {
  return io::write_steps_csv(entry_of(file, result));
}

std::vector<std::string> steps_pictures(const StepsFile& file, const StepsResult& result,
                                        const StepsOptions& options) {
  std::vector<std::string> pictures = {steps_svg(file, result)};
  if (auto strip = steps_strip_svg(file, result, {}, options)) {
    pictures.push_back(std::move(strip).value());
  }
  return pictures;
}

std::string name_of(const io::Document& document, const io::ReportOrigin& origin) {
  return document.name.empty() ? std::filesystem::path(origin.file).stem().string() : document.name;
}

std::string plan_html(io::ReportPage page, io::Document steps, int thread_count) {
  const StepsFile file{
      .name = std::string(page.name), .document = std::move(steps), .warnings = {}};
  const StepsOptions options = {.thread_count = thread_count};
  std::string text(page.text);
  if (io::step_count(file.document) > 0) {
    if (const auto judged = judge_steps(file, options)) {
      page.pictures = steps_pictures(file, judged.value(), options);
      text += "\n" + steps_text(file, judged.value());
    }
  }
  page.text = text;
  return io::write_report_page(page);
}

}  // namespace holdfast
