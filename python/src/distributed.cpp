// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/distributed.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common.hpp"
#include "holdfast/emulated.hpp"
#include "long_work.hpp"

/// The robot's own computation: simulated, and as firmware on emulated modules.
namespace holdfast::python {
namespace {

/// An event that happens to a module, or a plan, at a time in seconds, or in rounds: ("kill", 0.1,
/// cell), ("cut", 0.1, cell, "+x"), ("plan", 0.2, cell).
struct Event {
  std::string kind;
  double at = 0;
  base::Cell cell;
  std::string face;
};

struct Run {
  SharedStructure structure;
  CheckResult exact;
  EmulatedRun run;
  bool is_emulated = false;
};

constexpr std::array<const char*, 6> kFaces = {"+x", "-x", "+y", "-y", "+z", "-z"};

[[noreturn]] void refuse(const std::string& what, const std::string& found, const char* allowed) {
  throw Error(what + ": expected " + allowed + ", found '" + found + "'");
}

std::vector<Event> events_of(const py::handle& given) {
  std::vector<Event> events;
  for (const py::handle& entry : py::iter(given)) {
    const auto parts = py::reinterpret_borrow<py::object>(entry).cast<py::tuple>();
    if (parts.size() != 3 && parts.size() != 4) {
      throw Error("events: expected (kind, time, cell), with a face behind it for 'cut'");
    }
    Event& event = events.emplace_back();
    event.kind = utf8_of(py::object(parts[0]), "events");
    event.at = number_of(parts[1], "events: a time", 0, 1e9);
    event.cell = parts[2].is_none() ? agent::kEveryCell : cell_of(parts[2], "events");
    event.face = parts.size() == 4 ? utf8_of(py::object(parts[3]), "events") : "";
  }
  return events;
}

base::Direction face_of(const Event& event) {
  const auto found = std::ranges::find(kFaces, event.face);
  if (found == kFaces.end()) {
    refuse("events: the face of 'cut'", event.face, "+x, -x, +y, -y, +z or -z");
  }
  return static_cast<base::Direction>(found - kFaces.begin());
}

std::int32_t module_at(const Structure& structure, const base::Cell& cell) {
  const auto modules = structure.robot.modules();
  const auto found = std::ranges::find(modules, cell, &model::Module::cell);
  if (found == modules.end() || found->is_planned) {
    throw Error("events: no existing module is at " + model::text(cell));
  }
  return static_cast<std::int32_t>(found - modules.begin());
}

std::optional<Change::Kind> change_of(const std::string& kind) {
  return kind == "attach"     ? std::optional(Change::Kind::kAttach)
         : kind == "plan"     ? std::optional(Change::Kind::kPlan)
         : kind == "withdraw" ? std::optional(Change::Kind::kWithdraw)
                              : std::nullopt;
}

/// A structure with its changes, and the faults of any simulation of it.
struct Course {
  SharedStructure structure;
  std::optional<ChangedStructure> changed;
  std::vector<Event> faults;
};

Course course_of(const SharedStructure& structure, const std::vector<Event>& events,
                 double ticks_per_second) {
  Course course{.structure = structure, .changed = {}, .faults = {}};
  std::vector<Change> changes;
  for (const Event& event : events) {
    if (const auto kind = change_of(event.kind)) {
      changes.push_back({.kind = *kind,
                         .at = static_cast<sim::Time>(std::llround(event.at * ticks_per_second)),
                         .cell = event.cell});
    } else {
      course.faults.push_back(event);
    }
  }
  if (!changes.empty()) {
    course.changed = take(with_changes(*structure, std::move(changes)));
    course.structure = std::make_shared<const Structure>(course.changed->structure);
  }
  return course;
}

/// Reports how far the work is and continues it.
auto going_on(Watch& watch) {
  return [&watch](const sim::SimulationResult& result) {
    watch(result.events, result.rounds);
    return true;
  };
}

/// Adds what disturbs the lines: probabilities, and seconds for jitter.
void add_noise(sim::LinkModel& link, const py::dict& noise, double ticks) {
  for (const auto& [key, value] : noise) {
    const std::string name = utf8_of(key, "noise");
    const double number = number_of(value, "noise", 0, 1e6);
    if (name == "loss") {
      link.loss = number;
    } else if (name == "duplication") {
      link.duplication = number;
    } else if (name == "corruption") {
      link.corruption = number;
    } else if (name == "reordering") {
      link.reordering = number;
      link.reordering_delay = number > 0 ? 3 * sim::line_time(link, link.packet_bytes) : 0;
    } else if (name == "jitter") {
      link.jitter = static_cast<sim::Time>(std::llround(number * ticks));
    } else {
      refuse("noise", name,
             "loss, duplication, corruption, reordering (probabilities), jitter (seconds)");
    }
  }
}

std::shared_ptr<Run> simulate_robot(const SharedStructure& structure, const py::handle& link_name,
                                    const py::handle& method_name, const py::handle& seed,
                                    const py::dict& noise, const py::handle& events,
                                    py::object progress) {
  expect_one_piece(*structure, "simulate()");
  sim::SimulationOptions options;
  const std::string link = utf8_of(link_name, "link");
  const std::string method = utf8_of(method_name, "method");
  const auto found_link = sim::find_link_model(link);
  const auto found_method = find_method(method);
  if (!found_link || (!found_method && method != "auto")) {
    refuse(found_link ? "method" : "link", found_link ? method : link,
           found_link ? "auto, elimination, fronts or polynomial" : "v1, v2, catoms or unit");
  }
  options.link = *found_link;
  options.method = found_method;
  options.seed = seed_of(seed);
  const double ticks =
      options.link.ticks_per_second > 0 ? static_cast<double>(options.link.ticks_per_second) : 1.0;
  add_noise(options.link, noise, ticks);
  const Course course = course_of(structure, events_of(events), ticks);
  if (course.changed) {
    options.tells_planned = false;
    options.announcements = course.changed->announcements;
    options.faults = course.changed->attachments;
  }
  for (const Event& event : course.faults) {
    using Kind = sim::Fault::Kind;
    if (event.kind != "kill" && event.kind != "cut" && event.kind != "detach") {
      refuse("events", event.kind, "kill, cut, detach, attach, plan or withdraw");
    }
    const Kind kind = event.kind == "kill"  ? Kind::kKill
                      : event.kind == "cut" ? Kind::kCut
                                            : Kind::kDetach;
    options.faults.push_back({.kind = kind,
                              .at = static_cast<sim::Time>(std::llround(event.at * ticks)),
                              .module = module_at(*course.structure, event.cell),
                              .face = kind == Kind::kCut ? face_of(event) : base::Direction{}});
  }
  Watch watch(std::move(progress));
  auto run = std::make_shared<Run>(Run{.structure = course.structure, .exact = {}, .run = {}});
  run->run.run = take(without_gil(watch, [&] {
    run->exact = check(*course.structure);
    return simulate(*course.structure, run->exact, options, going_on(watch));
  }));
  return run;
}

std::shared_ptr<Run> emulate_robot(const SharedStructure& structure, const py::handle& image_path,
                                   const py::handle& seed, const py::handle& seconds_max,
                                   const py::handle& events, py::object progress) {
  constexpr double kTicks = 1e6;
  expect_one_piece(*structure, "emulate()");
  const double seconds = number_of(seconds_max, "seconds", 0.001, 3600);
  const std::string image = path_of(image_path);
  emulator::EmulationOptions options{.seed = seed_of(seed)};
  options.time_max = static_cast<sim::Time>(seconds * kTicks);
  const Course course = course_of(structure, events_of(events), kTicks);
  using Kind = emulator::Fault::Kind;
  if (course.changed) {
    options.tells_planned = false;
    options.announcements = course.changed->announcements;
    for (sim::Announcement& announcement : options.announcements) {
      announcement.at = std::max(announcement.at, options.plan_at);  // Modules have started then.
    }
    for (const sim::Fault& fault : course.changed->attachments) {
      options.faults.push_back({.kind = Kind::kAttach, .at = fault.at, .module = fault.module});
    }
  }
  for (const Event& event : course.faults) {
    if (event.kind != "kill" && event.kind != "cut" && event.kind != "flip" &&
        event.kind != "reset") {
      refuse("events", event.kind, "kill, cut, flip, reset, attach, plan or withdraw");
    }
    const Kind kind = event.kind == "kill"   ? Kind::kKill
                      : event.kind == "cut"  ? Kind::kCut
                      : event.kind == "flip" ? Kind::kFlip
                                             : Kind::kReset;
    const bool has_face = kind == Kind::kCut || kind == Kind::kFlip;
    options.faults.push_back({.kind = kind,
                              .at = static_cast<sim::Time>(event.at * kTicks),
                              .module = module_at(*course.structure, event.cell),
                              .face = has_face ? face_of(event) : base::Direction{}});
  }
  Watch watch(std::move(progress));
  auto run = std::make_shared<Run>(
      Run{.structure = course.structure, .exact = {}, .run = {}, .is_emulated = true});
  run->run = take(without_gil(watch, [&] {
    run->exact = check(*course.structure);
    return emulate(*course.structure, run->exact, image, options, going_on(watch));
  }));
  return run;
}

/// Numbers of the run, as docs/formats.md has them.
py::dict numbers(const Run& run) {
  const sim::SimulationResult& result = run.run.run.result;
  py::dict out;
  out["rounds"] = result.rounds;
  out["events"] = result.events;
  out["packets"] = result.packets;
  out["bytes"] = result.bytes;
  out["lost_packets"] = result.lost_packets;
  out["packets_module_max"] = result.packets_module_max;
  out["bytes_module_max"] = result.bytes_module_max;
  out["verdict_seconds"] = sim::seconds(run.run.run.link, result.verdict_time);
  out["all_agree"] = result.all_agree;
  out["trace_hash"] = result.trace_hash;
  if (run.is_emulated) {
    out["flash_bytes"] = run.run.firmware.flash_bytes;
    out["ram_bytes"] = run.run.firmware.ram_bytes;
    out["steps_unlike_host"] = run.run.firmware.mismatch_count;
  }
  return out;
}

py::array_t<double> load_ratios(const Run& run) {
  const auto& list = run.run.run.view.connections;
  py::array_t<double> out(static_cast<py::ssize_t>(list.size()));
  auto values = out.mutable_unchecked<1>();
  for (std::size_t i = 0; i < list.size(); ++i) {
    values(static_cast<py::ssize_t>(i)) = list[i].load_ratio;
  }
  return out;
}

}  // namespace

void add_distributed(py::module_& module) {
  py::class_<Run, std::shared_ptr<Run>>(module, "Run")
      .def_property_readonly("structure", [](const Run& r) { return r.structure; })
      .def_property_readonly("exact",
                             [](const Run& r) -> SharedCheck {
                               return std::make_shared<CheckedStructure>(r.structure, r.exact);
                             })
      .def_property_readonly("verdict",
                             [](const Run& r) { return static_cast<int>(r.run.run.view.verdict); })
      .def_property_readonly(
          "reason", [](const Run& r) { return agent::name(r.run.run.result.answer.reason); })
      .def_property_readonly("load_ratio_max",
                             [](const Run& r) { return r.run.run.view.load_ratio_max; })
      .def_property_readonly("load_ratios", &load_ratios)
      .def_property_readonly("numbers", &numbers)
      .def_property_readonly("notes", [](const Run& r) { return r.run.run.notes; })
      .def("json",
           [](const Run& r) {
             return r.is_emulated ? report_json(*r.structure, r.exact, r.run)
                                  : report_json(*r.structure, r.exact, r.run.run);
           })
      .def("text",
           [](const Run& r) {
             return r.is_emulated ? report_text(*r.structure, r.exact, r.run)
                                  : report_text(*r.structure, r.exact, r.run.run);
           })
      .def("svg", [](const Run& r, const io::FigureOptions& figure) {
        return picture_svg(*r.structure, r.run.run, figure);
      });
  module.def("simulate", &simulate_robot);
  module.def("emulate", &emulate_robot);
  module.def("can_emulate", &emulator::is_available);
}

}  // namespace holdfast::python
