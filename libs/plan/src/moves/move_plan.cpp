// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/move_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "moves/move_judge.hpp"
#include "moves/move_rules.hpp"
#include "moves/shape_search.hpp"
#include "moves/slide_moves.hpp"
#include "moves/surface_planner.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

/// What is wrong with one of the two robots; `which` says which.
std::optional<base::Error> find_robot_fault(const MoveTask& task, const model::RobotSpec& spec,
                                            const std::string& which) {
  if (!spec.planned.empty()) {
    return base::bad_input(
        fmt::format("{} has planned modules; expected robots as they stand", which));
  }
  if (!spec.released.empty()) {
    return base::bad_input(
        fmt::format("{} has open faces between neighbours; all must be connected", which));
  }
  const auto is_inside = [](const model::OwnConnector& own) {
    return own.body != model::OwnConnector::kNoBody;
  };
  if (std::ranges::any_of(spec.own_connectors, is_inside)) {
    return base::bad_input(
        fmt::format("{} has bodies of several modules, and modules move one by one", which));
  }
  if (!spec.own_connectors.empty()) {
    return base::bad_input(fmt::format(
        "{} has connections with laws of their own, which stay with no module that moves", which));
  }
  const auto robot = model::Robot::create(spec);
  if (!robot) {
    return base::bad_input(which + ": " + robot.error().message);
  }
  return find_cell_fault(task, spec, which);
}

/// A task whose robots can be computed.
struct Problem {
  MoveRule rule;
  ShapeSpace space;
};

base::Result<Problem> make_problem(const MoveTask& task) {
  if (task.motions && task.motions->lattice != task.start.lattice) {
    return base::bad_input(motions_of_other_lattice(*task.motions));
  }
  if (auto fault = find_robot_fault(task, task.start, "the robot")) {
    return *std::move(fault);
  }
  if (auto fault = find_robot_fault(task, task.target, "the target")) {
    return *std::move(fault);
  }
  std::vector<CellBox> kept;
  for (const Cell& cell : task.keep) {
    kept.push_back(box_between(cell, cell));
  }
  if (const auto modules = kept_modules(kept, task.start.existing); !modules) {
    return modules.error();
  }
  auto space = ShapeSpace::create(kept_state(task, task.start), kept_state(task, task.target));
  if (!space) {
    return space.error();
  }
  return Problem{.rule = rule_of(task), .space = std::move(space).value()};
}

Judgement judge_spec(const model::RobotSpec& spec, const MoveOptions& options) {
  return judge(model::Robot::create(spec, options.solver.thread_count).value(), options.solver);
}

/// One search for one plan.
class Search {
 public:
  Search(const MoveTask& task, const MoveOptions& options, const Problem& problem)
      : task_(task),
        options_(options),
        problem_(problem),
        reversed_(problem.space.reversed()),
        judge_(task, options),
        forth_(problem.space, problem.rule, judge_, options.seed, End::kStart),
        back_(reversed_, problem.rule, judge_, options.seed, End::kTarget) {}

  /// A first plan along the surface, then the exact search for a shorter one; and where neither
  /// finds any, more of both in turns.
  MovePlan run() {
    const ShapeSpace& space = problem_.space;
    plan_.assignment_bound = space.assignment_bound(space.start());
    if (space.start() == space.target()) {
      keep({}, 0);
    } else {
      seek();
    }
    plan_.state_count = judge_.count();
    plan_.is_shortest = plan_.outcome == MoveOutcome::kFound && length() <= plan_.length_min;
    return std::move(plan_);
  }

 private:
  void seek() {
    const std::size_t module_count = problem_.space.start().size();
    if (module_count > kSearchedMax) {
      slide();
    }
    if (plan_.outcome != MoveOutcome::kFound) {
      walk(0);
    }
    std::size_t count = options_.exact_count_max / module_count;
    for (std::uint64_t attempt = 1;
         !is_left_so() && !search(count) && !is_exhausted_ && !judge_.is_over(); ++attempt) {
      count = walk(attempt);
      if (attempt == 1 && module_count <= kSearchedMax && plan_.outcome != MoveOutcome::kFound) {
        slide();
      }
    }
    plan_.undecided_count = judge_.undecided_count();
    plan_.length_min = plan_.assignment_bound;
    if (plan_.undecided_count == 0) {
      plan_.length_min = std::max({plan_.length_min, forth_.length_min(), back_.length_min()});
    }
    if (plan_.outcome == MoveOutcome::kFound && module_count <= kSearchedMax &&
        length() > plan_.length_min) {
      slide();
    }
    if (plan_.outcome == MoveOutcome::kFound) {
      plan_.length_min = std::min(plan_.length_min, length());
    }
  }

  /// Many cubes at a time, which ends soon.
  void slide() {
    auto found = find_slides(problem_.space, problem_.rule, options_.seed, judge_);
    if (!found) {
      return;
    }
    Shape shape = problem_.space.start();
    for (const model::Move& move : found->moves) {
      shape = problem_.space.after(shape, move.from, move.to);
    }
    const bool is_kept = keep(found->moves, problem_.space.distance(shape));
    if (is_kept && !task_.ignores_mechanics && !found->moves.empty()) {
      plan_.judgement = sum_up(std::move(found->judged));
    }
  }

  /// Whether a plan of many modules is so much longer than the bound of the search that this would
  /// see too many shapes.
  bool is_left_so() const {
    constexpr int kHopeful = 6;
    return plan_.outcome == MoveOutcome::kFound && problem_.space.start().size() > kSearchedMax &&
           length() - problem_.space.distance(problem_.space.start()) > kHopeful;
  }

  /// One attempt along the surface. Returns how many moves it has judged.
  std::size_t walk(std::uint64_t attempt) {
    const std::size_t before = judge_.count();
    SurfacePlanner planner(problem_.space, problem_.rule, judge_, options_.seed, attempt);
    planner.run();
    keep(planner.moves(), planner.distance());
    return judge_.count() - before;
  }

  /// Goes on with the exact search by so many moves, and a few; where no plan is known by some from
  /// the target backwards too, which proves at once that one that nothing leads to cannot be
  /// reached. Whether there is an answer.
  bool search(std::size_t count) {
    constexpr std::size_t kFew = 100;
    constexpr std::size_t kBackwardShare = 4;
    const bool is_known = plan_.outcome == MoveOutcome::kFound;
    settle(forth_, End::kStart,
           forth_.run(judge_.count() + count + kFew,
                      is_known ? length() : std::numeric_limits<int>::max()));
    if (plan_.outcome == MoveOutcome::kNotFound) {
      settle(back_, End::kTarget, back_.run(judge_.count() + count / kBackwardShare + kFew));
    }
    return plan_.outcome != MoveOutcome::kNotFound;
  }

  void settle(const ShapeSearch& search, End end, SearchOutcome outcome) {
    if (outcome == SearchOutcome::kExhausted && judge_.undecided_count() > 0) {
      is_exhausted_ = true;
    } else if (outcome == SearchOutcome::kExhausted) {
      plan_ = {.outcome = MoveOutcome::kNone, .assignment_bound = plan_.assignment_bound};
      plan_.certificate = MoveCertificate{
          .task = task_, .shapes = search.shapes(), .is_backward = end == End::kTarget};
    } else if (outcome == SearchOutcome::kFound) {
      distance_ = std::numeric_limits<int>::max();
      keep(search.moves(), 0);
    } else if (end == End::kStart) {
      keep(search.moves(), search.distance());
    }
  }

  int length() const { return static_cast<int>(plan_.steps.size()); }

  /// Keeps moves to a shape nearer than any before, or a shorter plan; whether it does.
  bool keep(const std::vector<model::Move>& moves, int distance) {
    const bool is_shorter =
        distance == 0 && plan_.outcome == MoveOutcome::kFound && moves.size() < plan_.steps.size();
    if (distance >= distance_ && !is_shorter) {
      return false;
    }
    distance_ = distance;
    plan_.outcome = distance == 0 ? MoveOutcome::kFound : MoveOutcome::kNotFound;
    plan_.steps.clear();
    plan_.judgement.reset();
    for (const model::Move& move : moves) {
      plan_.steps.push_back(step_of(move));
    }
    return true;
  }

  const MoveTask& task_;
  const MoveOptions& options_;
  const Problem& problem_;
  ShapeSpace reversed_;
  MoveJudge judge_;
  ShapeSearch forth_;
  ShapeSearch back_;
  MovePlan plan_;
  int distance_ = std::numeric_limits<int>::max();
  bool is_exhausted_ = false;  ///< Nothing is left to try but undecided moves.
};

MovePlan unsafe_target(const MoveTask& task, const ShapeSpace& space, const Judgement& judgement) {
  MovePlan plan;
  plan.assignment_bound = plan.length_min = space.assignment_bound(space.start());
  if (judgement.verdict == verdict::Verdict::kUndecided) {
    plan.undecided_count = 1;
    return plan;
  }
  plan.outcome = MoveOutcome::kNone;
  plan.certificate = MoveCertificate{.task = task, .target = judgement};
  return plan;
}

/// Judges the steps anew, as one sequence, unless they were judged so when they were found. If they
/// need not be safe, as far as time reaches.
std::optional<base::Error> judge_plan(const MoveTask& task, const MoveOptions& options,
                                      const Patience& patience, MovePlan& plan) {
  if (plan.steps.empty() || plan.judgement) {
    return std::nullopt;
  }
  SequenceOptions sequence{.solver = options.solver};
  if (task.ignores_mechanics) {
    sequence.is_interrupted = [&] { return patience.is_over(); };
  }
  auto judged = judge_sequence(task.start, plan.steps, sequence);
  if (!judged) {
    return judged.error();
  }
  HOLDFAST_CHECK(task.ignores_mechanics || judged.value().verdict() == verdict::Verdict::kSafe);
  plan.judgement = std::move(judged).value();
  return std::nullopt;
}

/// Makes every move across the border of a certificate's shapes anew.
base::Result<MoveCertificateCheck> replay(const MoveCertificate& certificate,
                                          const Problem& problem, const MoveOptions& options) {
  const bool is_backward = certificate.is_backward;
  const ShapeSpace space = is_backward ? problem.space.reversed() : problem.space;
  const std::set<Shape> inside(certificate.shapes.begin(), certificate.shapes.end());
  if (!inside.contains(space.start()) || inside.contains(space.target())) {
    return base::bad_input("of start and target the wrong one is among the shapes");
  }
  MoveJudge judge(certificate.task, options);
  MoveCertificateCheck check{.shape_count = inside.size()};
  for (const Shape& shape : inside) {
    const RobotState robot = space.state_of(shape);
    for (const std::int32_t module : loose_modules(robot)) {
      for (const model::Move& move : moves_of(robot, module, problem.rule)) {
        const Shape next = space.after(shape, move.from, move.to);
        if (inside.contains(next)) {
          continue;
        }
        const model::Move made = is_backward ? back(move) : move;
        if (is_backward ? judge.is_safe(space.state_of(next), made, shape)
                        : judge.is_safe(robot, made, next)) {
          return base::bad_input(
              fmt::format("the module {} can go to {} safely, across the border of "
                          "the shapes",
                          model::text(made.from), model::text(made.to)));
        }
        if (judge.undecided_count() > 0) {
          return base::bad_input(
              fmt::format("whether the module {} can go to {} safely is undecided",
                          model::text(made.from), model::text(made.to)));
        }
        ++check.unsafe_count;
      }
    }
  }
  return check;
}

}  // namespace

const char* name(MoveOutcome outcome) {
  switch (outcome) {
    case MoveOutcome::kFound:
      return "found";
    case MoveOutcome::kNone:
      return "none";
    case MoveOutcome::kNotFound:
      break;
  }
  return "not-found";
}

base::Result<MovePlan> find_moves(const MoveTask& task, const MoveOptions& options) {
  const auto problem = make_problem(task);
  if (!problem) {
    return problem.error();
  }
  if (!task.ignores_mechanics) {
    const Judgement start = judge_spec(task.start, options);
    if (!start.is_safe()) {
      return base::bad_input(fmt::format(
          "the robot is {} before any step; a plan begins with a safe one", verdict_text(start)));
    }
    const Judgement target = judge_spec(task.target, options);
    if (!target.is_safe()) {
      return unsafe_target(task, problem.value().space, target);
    }
  }
  const Patience patience(options.seconds_max, options.is_interrupted);
  MovePlan plan = Search(task, options, problem.value()).run();
  if (auto error = judge_plan(task, options, patience, plan)) {
    return *std::move(error);
  }
  return plan;
}

base::Result<MoveCertificateCheck> verify(const MoveCertificate& certificate,
                                          const solver::EquilibriumOptions& options) {
  const MoveTask& task = certificate.task;
  const auto problem = make_problem(task);
  if (!problem) {
    return problem.error();
  }
  const MoveOptions more{.solver = options};
  if (certificate.target && task.ignores_mechanics) {
    return base::bad_input(
        "the certificate says that the target is not safe, which proves nothing where steps need "
        "not be safe");
  }
  if (certificate.target) {
    const Judgement target = judge_spec(task.target, more);
    if (target.is_safe() || target.verdict == verdict::Verdict::kUndecided) {
      return base::bad_input(fmt::format("the target is {}", verdict::name(target.verdict)));
    }
    return MoveCertificateCheck{.target = target.verdict};
  }
  return replay(certificate, problem.value(), more);
}

}  // namespace holdfast::plan
