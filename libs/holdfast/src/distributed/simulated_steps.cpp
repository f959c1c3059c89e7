// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/simulated_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "distributed/distributed_parts.hpp"
#include "report_entry.hpp"

namespace holdfast {
namespace {

using Cells = std::vector<base::Cell>;
using Kind = StepChange::Kind;

base::Error unsupported(const StepsFile& file, std::size_t step, const char* what) {
  return {.code = base::ErrorCode::kUnsupported,
          .message = fmt::format("step {} {}: simulated are steps that attach and detach modules",
                                 step, what),
          .where = io::step_pointer(file.document, step)};
}

std::optional<base::Error> find_fault(const StepsFile& file, const io::Sequence& sequence) {
  for (std::size_t i = 0; i < sequence.steps.size(); ++i) {
    const model::Step& step = sequence.steps[i];
    if (!step.moves.empty()) {
      return unsupported(file, i, "moves modules");
    }
    if (!step.release.empty() || !step.connect.empty()) {
      return unsupported(file, i, "releases or makes connections");
    }
  }
  return std::nullopt;
}

bool has(const Cells& cells, const base::Cell& cell) {
  return std::ranges::find(cells, cell) != cells.end();
}

/// The items of a list that belong to a cell.
template <class Item>
std::vector<Item> of_cell(const std::vector<Item>& items, const base::Cell& cell) {
  std::vector<Item> found;
  std::ranges::copy_if(items, std::back_inserter(found),
                       [&](const Item& item) { return item.cell == cell; });
  return found;
}

/// Whether the module that a step attaches in a cell is like the one that was there before. None
/// that comes is fixed.
bool is_alike(const model::RobotSpec& robot, const model::Step& step, const base::Cell& cell) {
  return !has(robot.fixed, cell) &&
         of_cell(robot.own_kinds, cell) == of_cell(step.own_kinds, cell) &&
         of_cell(robot.own_masses, cell) == of_cell(step.own_masses, cell) &&
         of_cell(robot.payloads, cell) == of_cell(step.payloads, cell);
}

template <class Item>
void append(std::vector<Item>& items, const std::vector<Item>& more) {
  items.insert(items.end(), more.begin(), more.end());
}

/// The robot with all modules that are ever there. Modules know the world by its cells, so what is
/// in a cell is the same whenever anything is.
base::Result<model::RobotSpec> whole_of(const StepsFile& file, const io::Sequence& sequence) {
  model::RobotSpec whole = sequence.start;
  for (std::size_t i = 0; i < sequence.steps.size(); ++i) {
    const model::Step& step = sequence.steps[i];
    for (const base::Cell& cell : step.attach) {
      if (!has(whole.existing, cell)) {
        whole.existing.push_back(cell);
        append(whole.own_kinds, of_cell(step.own_kinds, cell));
        append(whole.own_masses, of_cell(step.own_masses, cell));
        append(whole.payloads, of_cell(step.payloads, cell));
      } else if (!is_alike(whole, step, cell)) {
        return unsupported(file, i, "attaches another kind of module where one was before");
      }
    }
  }
  return whole;
}

/// A simulated robot to which one thing happens after the other.
class Follower {
 public:
  Follower(const model::Robot& robot, const sim::SimulationOptions& options)
      : simulation_(robot, options) {}

  StepAnswer follow(const std::vector<sim::Announcement>& announcements,
                    const std::vector<sim::Fault>& faults) {
    const sim::SimulationResult before = simulation_.result();
    for (const sim::Announcement& announcement : announcements) {
      simulation_.happen(announcement);
    }
    for (const sim::Fault& fault : faults) {
      simulation_.happen(fault);
    }
    simulation_.run();
    const sim::SimulationResult after = simulation_.result();
    return {.answer = after.answer,
            .all_agree = after.all_agree,
            .time = after.verdict_time > before.time ? after.verdict_time - before.time : 0,
            .rounds = after.rounds - before.rounds,
            .packets = after.packets - before.packets};
  }

  std::size_t bytes_per_module() const { return simulation_.result().bytes_per_module; }

 private:
  sim::Simulation simulation_;
};

sim::SimulationOptions options_of(const sim::SimulationOptions& options,
                                  const io::Sequence& sequence, std::size_t count, bool keeps) {
  sim::SimulationOptions mine = options;
  mine.keeps_answers = keeps;
  mine.deflates = keeps;
  mine.tells_planned = false;
  mine.plans_many = std::ranges::any_of(sequence.steps, [](const model::Step& step) {
    return step.attach.size() > std::size_t{agent::kPlannedMax};
  });
  for (std::size_t i = sequence.start.existing.size(); i < count; ++i) {
    mine.absent.push_back(static_cast<std::int32_t>(i));
  }
  return mine;
}

/// The two robots, and the modules that are there.
class Run {
 public:
  Run(const model::Robot& robot, const model::RobotSpec& whole, const io::Sequence& sequence,
      const sim::SimulationOptions& options)
      : whole_(whole),
        cells_(whole.existing),
        now_(sequence.start),
        kept_(robot, options_of(options, sequence, cells_.size(), true)),
        fresh_(robot, options_of(options, sequence, cells_.size(), false)) {}

  std::optional<base::Error> start() { return note({.kind = Kind::kStart}, {}, {}); }

  std::optional<base::Error> take(std::size_t index, const model::Step& step) {
    for (const base::Cell& cell : step.detach) {
      std::erase(now_.existing, cell);
      std::erase(now_.fixed, cell);
    }
    if (auto error = change(index, Kind::kDetach, step.detach)) {
      return error;
    }
    now_.planned = step.attach;
    if (auto error = change(index, Kind::kPlan, step.attach)) {
      return error;
    }
    now_.planned.clear();
    append(now_.existing, step.attach);
    return change(index, Kind::kAttach, step.attach);
  }

  std::vector<StepChange> changes() && { return std::move(changes_); }

  std::size_t bytes_per_module() const { return kept_.bytes_per_module(); }

 private:
  std::int32_t index_of(const base::Cell& cell) const {
    return static_cast<std::int32_t>(std::ranges::find(cells_, cell) - cells_.begin());
  }

  /// All the cells at once: a step counts as a whole.
  std::optional<base::Error> change(std::size_t step, Kind kind, const Cells& cells) {
    if (cells.empty()) {
      return std::nullopt;
    }
    std::vector<sim::Announcement> announcements;
    std::vector<sim::Fault> faults;
    const std::int32_t told = index_of(now_.existing.front());
    for (const base::Cell& cell : cells) {
      if (kind == Kind::kPlan) {
        announcements.push_back({.module = told, .cell = cell});
      } else {
        faults.push_back(
            {.kind = kind == Kind::kAttach ? sim::Fault::Kind::kAttach : sim::Fault::Kind::kDetach,
             .module = index_of(cell)});
      }
    }
    if (kind == Kind::kAttach && cells.size() > std::size_t{agent::kPlannedMost}) {
      // Plans that found no place are in no module, so none of them ends by what comes.
      announcements.push_back({.module = told, .cell = agent::kEveryCell, .is_withdrawal = true});
    }
    return note({.step = step, .kind = kind, .cells = cells}, announcements, faults);
  }

  std::optional<base::Error> note(StepChange change,
                                  const std::vector<sim::Announcement>& announcements,
                                  const std::vector<sim::Fault>& faults) {
    now_.own_kinds = whole_.own_kinds;
    now_.own_masses = whole_.own_masses;
    now_.own_connectors = whole_.own_connectors;
    now_.payloads = whole_.payloads;
    model::forget_absent(now_);
    const auto robot = model::Robot::create(now_);
    if (!robot) {
      return robot.error();
    }
    const verdict::Assessment exact = check(robot.value()).assessment;
    change.exact = exact.verdict;
    change.load_ratio_exact = exact.is_stable ? exact.load_ratio_max.value_or(0) : 0;
    change.kept = kept_.follow(announcements, faults);
    change.fresh = fresh_.follow(announcements, faults);
    changes_.push_back(std::move(change));
    return std::nullopt;
  }

  const model::RobotSpec& whole_;
  Cells cells_;  ///< By index in the simulations.
  model::RobotSpec now_;
  Follower kept_;
  Follower fresh_;
  std::vector<StepChange> changes_;
};

double median_share(const std::vector<StepChange>& changes) {
  std::vector<double> shares;
  for (std::size_t i = 1; i < changes.size();) {
    double kept = 0;
    double fresh = 0;
    const std::size_t step = changes[i].step;
    for (; i < changes.size() && changes[i].step == step; ++i) {
      kept += static_cast<double>(changes[i].kept.time);
      fresh += static_cast<double>(changes[i].fresh.time);
    }
    shares.push_back(fresh > 0 ? kept / fresh : 1);
  }
  if (shares.empty()) {
    return 0;
  }
  std::ranges::sort(shares);
  const std::size_t half = shares.size() / 2;
  return shares.size() % 2 == 1 ? shares[half] : (shares[half - 1] + shares[half]) / 2;
}

std::string cells_text(const StepChange& change) {
  std::string text;
  for (const base::Cell& cell : change.cells) {
    text += (text.empty() ? " " : ", ") + model::text(cell);
  }
  return text;
}

/// The time as text, in rounds if ticks have no length.
std::string time_or_rounds(const sim::LinkModel& link, sim::Time time) {
  return time_text(link, time, fmt::format("{}", time));
}

void write_answer(io::JsonStream& json, const sim::LinkModel& link, const StepAnswer& answer) {
  json.begin_object();
  json.member("verdict", verdict::name(to_verdict(answer.answer.verdict)));
  json.member("reason", agent::name(answer.answer.reason));
  json.member("load_ratio_max", load_ratio_max(answer.answer));
  json.member("all_modules_agree", answer.all_agree);
  json.member("rounds", answer.rounds);
  json.member("simulated_s", sim::seconds(link, answer.time));
  json.member("messages", answer.packets);
  json.end_object();
}

void write_change(io::JsonStream& json, const sim::LinkModel& link, const StepChange& change) {
  json.begin_object();
  json.member("change", name(change.kind));
  json.member("step", change.kind == Kind::kStart ? std::nullopt : std::optional(change.step));
  json.key("cells");
  json.begin_array();
  for (const base::Cell& cell : change.cells) {
    json.value(cell);
  }
  json.end_array();
  json.member("exact", verdict::name(change.exact));
  json.key("kept");
  write_answer(json, link, change.kept);
  json.key("fresh");
  write_answer(json, link, change.fresh);
  json.end_object();
}

}  // namespace

const char* name(StepChange::Kind kind) {
  constexpr const char* kNames[] = {"start", "plan", "attach", "detach"};
  return kNames[static_cast<std::size_t>(kind)];
}

base::Result<SimulatedSteps> simulate_steps(const StepsFile& file,
                                            const sim::SimulationOptions& options,
                                            const std::function<void(std::size_t step)>& progress) {
  const auto sequence = io::make_sequence(file.document);
  if (!sequence) {
    return sequence.error();
  }
  if (const auto error = find_fault(file, sequence.value())) {
    return *error;
  }
  const auto whole = whole_of(file, sequence.value());
  if (!whole) {
    return whole.error();
  }
  const auto robot = model::Robot::create(whole.value());
  if (!robot) {
    return robot.error();
  }
  if (const auto fault = sim::find_options_fault(robot.value(), options)) {
    return base::Error{.code = base::ErrorCode::kBadInput, .message = *fault, .where = {}};
  }
  Run run(robot.value(), whole.value(), sequence.value(), options);
  auto error = run.start();
  for (std::size_t i = 0; !error && i < sequence.value().steps.size(); ++i) {
    if (progress) {
      progress(i);
    }
    error = run.take(i, sequence.value().steps[i]);
    if (error && error->where.empty()) {
      error->where = io::step_pointer(file.document, i);
    }
  }
  if (error) {
    return *error;
  }
  SimulatedSteps result{.link = options.link, .bytes_per_module = run.bytes_per_module()};
  result.changes = std::move(run).changes();
  result.time_share_median = median_share(result.changes);
  return result;
}

verdict::Verdict worst_verdict(const SimulatedSteps& steps) {
  const auto has = [&](agent::Verdict verdict) {
    return std::ranges::any_of(steps.changes, [verdict](const StepChange& change) {
      return change.kept.answer.verdict == verdict;
    });
  };
  for (const agent::Verdict verdict : {agent::Verdict::kUnstable, agent::Verdict::kOverload,
                                       agent::Verdict::kNone, agent::Verdict::kUndecided}) {
    if (has(verdict)) {
      return to_verdict(verdict);
    }
  }
  return verdict::Verdict::kSafe;
}

std::string simulated_steps_text(const StepsFile& file, const SimulatedSteps& steps,
                                 const TextOptions& options) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "  {:>5} {:<10} {:<10} {:>10} {:>21} {:>17}  {}\n", "step", "exact", "robot",
                 "load ratio", "time kept, fresh", "packets", "what happens");
  for (const StepChange& change : steps.changes) {
    const agent::Answer& answer = change.kept.answer;
    const std::string step = change.kind == Kind::kStart ? "" : fmt::format("{}", change.step);
    const auto ratio = load_ratio_max(answer);
    fmt::format_to(
        out, "  {:>5} {:<10} {:<10} {:>10} {:>10} {:>10} {:>8} {:>8}  {}{}{}\n", step,
        verdict::name(change.exact), verdict::name(to_verdict(answer.verdict)),
        ratio ? io::beside_one(*ratio, 4) : "-", time_or_rounds(steps.link, change.kept.time),
        time_or_rounds(steps.link, change.fresh.time), change.kept.packets, change.fresh.packets,
        name(change.kind), cells_text(change), change.kept.all_agree ? "" : "; NOT all agree");
  }
  fmt::format_to(out,
                 "  from what the robot keeps a step takes {:.2f} of the time, in the median\n",
                 steps.time_share_median);
  add_notes(text, file.warnings, options);
  return text;
}

void write_simulated_steps_json(std::ostream& out, const StepsFile& file,
                                const SimulatedSteps& steps) {
  std::string text;
  io::JsonStream json(text);
  json.begin_object();
  io::write_report_head(
      json,
      {.command = "simulate", .origin = file.origin, .module_count = file.document.modules.size()});
  json.member("name", file.name);
  json.member("time_share_median", steps.time_share_median);
  json.member("bytes_per_module", steps.bytes_per_module);
  json.key("changes");
  json.begin_array();
  for (const StepChange& change : steps.changes) {
    write_change(json, steps.link, change);
  }
  json.end_array();
  json.end_object();
  out << text;
}

}  // namespace holdfast
