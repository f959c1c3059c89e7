// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "session.hpp"

#include <cstdlib>
#include <iostream>
#include <utility>

#include "holdfast/sim/trace.hpp"

namespace holdfast::visiblesim {
namespace {

constexpr int kExitBadInput = 65;

[[noreturn]] void give_up(const std::string& path, const base::Error& error) {
  std::cerr << "holdfast: " << path << ": " << (error.where.empty() ? "" : error.where + ": ")
            << error.message << std::endl;
  std::exit(kExitBadInput);
}

}  // namespace

Session& Session::instance() {
  static Session session;
  return session;
}

void Session::open(const std::string& path) {
  auto structure = load_file(path);
  if (!structure) {
    give_up(path, structure.error());
  }
  for (const std::string& warning : structure.value().warnings) {
    std::cerr << "holdfast: note: " << warning << '\n';
  }
  const model::Robot& robot = structure.value().robot;
  auto fault = sim::find_floor_fault(robot);
  fault = fault ? fault : sim::find_options_fault(robot, settings.simulation);
  if (fault) {
    give_up(path, {base::ErrorCode::kUnsupported, *fault, ""});
  }
  const auto shift = io::visiblesim_shift(structure.value().document);
  if (!shift) {
    give_up(path, shift.error());
  }
  shift_ = shift.value();
  ensemble_ = std::make_unique<Ensemble>(std::move(structure).value(), settings.simulation);
  ensemble_->on_verdict([this] { take_verdict(); });
}

base::Cell Session::own_cell(const base::Cell& cell) const {
  return {cell.x - shift_.x, cell.y - shift_.y, cell.z - shift_.z};
}

base::Cell Session::visiblesim_cell(const base::Cell& cell) const {
  return {cell.x + shift_.x, cell.y + shift_.y, cell.z + shift_.z};
}

void Session::start(bool is_endless) {
  if (!std::exchange(is_started_, true)) {
    is_endless_ = is_endless;
    if (is_endless) {
      ensemble_->watch_for_ever();
    }
    started_at_ = std::chrono::steady_clock::now();
  }
}

/// Every module knows a verdict.
void Session::take_verdict() {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started_at_;
  verdict_wall_seconds_ = wall.count();
  const sim::SimulationResult result = ensemble_->result();
  const std::string text = result.all_agree ? "The robot " + sim::describe(result.answer)
                                            : "The robot's modules do not agree";
  {
    const std::scoped_lock lock(status_mutex_);
    status_ = text;
  }
  std::cout << static_cast<double>(result.verdict_time) * 1e-6 << " s  " << text << std::endl;
  if (is_endless_) {
    finish();
  }
}

void Session::finish() {
  const auto report = ensemble_->report();
  if (!report) {
    std::cout << "holdfast: what is there now is no robot: " << report.error().message << std::endl;
    return;
  }
  const auto& [structure, exact, run] = report.value();
  std::cout << '\n'
            << verdict::name(run.view.verdict) << "  " << structure.name << '\n'
            << report_text(structure, exact, run) << "\n  wall        " << verdict_wall_seconds_
            << " s in VisibleSim, to the verdict" << std::endl;
  if (settings.json.empty()) {
    return;
  }
  if (const auto error = write_file(settings.json, report_json(structure, exact, run))) {
    std::cerr << "holdfast: " << settings.json << ": " << error->message << std::endl;
  }
}

std::string Session::status() {
  const std::scoped_lock lock(status_mutex_);
  return status_;
}

int Session::exit_code() const {
  switch (ensemble_->result().answer.verdict) {
    case agent::Verdict::kSafe:
      return 0;
    case agent::Verdict::kOverload:
    case agent::Verdict::kUnstable:
      return 1;
    case agent::Verdict::kNone:
    case agent::Verdict::kUndecided:
      break;
  }
  return 2;
}

}  // namespace holdfast::visiblesim
