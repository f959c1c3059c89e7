// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/holdfast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iterator>
#include <thread>
#include <vector>

#include "holdfast/base/check.hpp"
#include "holdfast/file_ending.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/io/near_miss.hpp"
#include "holdfast/limit/robot.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/verdict/deformed.hpp"
#include "report_entry.hpp"

namespace holdfast {

io::ReportEntry entry_of(const Structure& structure, const CheckResult& result) {
  return {.origin = structure.origin,
          .name = structure.name,
          .robot = &structure.robot,
          .assessment = &result.assessment,
          .warnings = structure.warnings,
          .seconds = result.seconds,
          .proof = result.proof ? &*result.proof : nullptr,
          .proof_seconds = result.proof_seconds,
          .limit = result.limit ? &*result.limit : nullptr,
          .limit_seconds = result.limit_seconds,
          .is_deformed = result.is_deformed,
          .deformed = result.deformed ? &*result.deformed : nullptr,
          .deformed_seconds = result.deformed_seconds};
}

void add_notes(std::string& text, std::span<const std::string> notes, const TextOptions& options) {
  for (const std::string& note : options.has_notes ? notes : std::span<const std::string>()) {
    text += fmt::format("  note        {}\n", note);
  }
}

std::string_view version() { return io::program_version(); }

base::Result<Structure> make_structure(io::Document document, std::string_view name,
                                       int thread_count) {
  auto robot = io::make_robot(document, thread_count);
  if (!robot) {
    return robot.error();
  }
  std::vector<std::string> doubts = io::doubtful_figures(document);
  std::string title = document.name.empty() ? std::string(name) : document.name;
  return Structure{.name = std::move(title),
                   .document = std::move(document),
                   .robot = std::move(robot).value(),
                   .warnings = std::move(doubts)};
}

namespace {

base::Result<Structure> structure_of(base::Result<io::ReadDocument> read, std::string_view name,
                                     int thread_count) {
  if (!read) {
    return read.error();
  }
  auto [document, warnings] = std::move(read).value();
  if (document.steps.size() > 1 || !document.extension.plan.empty()) {
    const bool is_one = io::step_count(document) == 1;
    const bool is_first_judged = !document.steps.empty() && io::first_step(document) == 0;
    warnings.push_back(fmt::format("{} {} read; the robot {} is judged, holdfast steps judges all",
                                   host::counted(io::step_count(document), "step"),
                                   is_one ? "is" : "are",
                                   is_first_judged ? "after the first"
                                   : is_one        ? "before it"
                                                   : "before them"));
  }
  auto made = make_structure(std::move(document), name, thread_count);
  if (!made) {
    base::Error error = made.error();
    error.notes = std::move(warnings);
    return error;
  }
  Structure structure = std::move(made).value();
  structure.warnings = std::move(warnings);
  return structure;
}

}  // namespace

base::Result<Structure> load_text(std::string_view text, std::string_view name, int thread_count,
                                  const io::ReadOptions& options) {
  return structure_of(io::read_document(text, options), name, thread_count);
}

base::Result<io::ReadDocument> read_structure(const std::filesystem::path& path,
                                              const io::ReadOptions& options) {
  const auto text = read_file(path);
  if (!text) {
    return text.error();
  }
  io::ReadOptions more = options;
  more.ending = options.ending.empty() ? ending_of(path.string()) : options.ending;
  return io::read_document(text.value(), more);
}

base::Result<Structure> load_file(const std::filesystem::path& path, int thread_count,
                                  const io::ReadOptions& options) {
  auto loaded = structure_of(read_structure(path, options), path.stem().string(), thread_count);
  if (!loaded) {
    return loaded;
  }
  Structure structure = std::move(loaded).value();
  structure.origin.file = path.string();
  return structure;
}

base::Result<io::Document> generate(std::string_view family, std::size_t size) {
  const auto found = std::ranges::find(model::families(), family, &model::FamilyInfo::name);
  if (found == model::families().end()) {
    std::vector<std::string_view> names;
    std::ranges::transform(model::families(), std::back_inserter(names), &model::FamilyInfo::name);
    const auto meant = io::near_miss(family, names);
    return base::bad_input(
        fmt::format("no family '{}'{}", io::one_line(family),
                    meant ? "; " + io::did_you_mean(*meant)
                          : fmt::format(", there are {}", fmt::join(names, ", "))));
  }
  const std::size_t count = model::family_count(found->family, size);
  if (size < found->size_min || count > model::kModuleCountMax) {
    return base::Error{.code = base::ErrorCode::kBadInput,
                       .message = fmt::format(
                           "expected a size of {} or more for {}, and at most {} modules in all; "
                           "found {}",
                           found->size_min, family, model::kModuleCountMax, size)};
  }
  io::Document document;
  document.name = fmt::format("{} {}", family, size);
  document.description = found->help;
  document.extension.lattice = found->lattice;
  document.modules.reserve(count);
  for (const base::Cell& cell : model::family_cells(found->family, size)) {
    document.modules.emplace_back().cell = cell;
  }
  return document;
}

std::vector<std::pair<std::string_view, std::string_view>> family_list() {
  std::vector<std::pair<std::string_view, std::string_view>> list;
  for (const model::FamilyInfo& info : model::families()) {
    list.emplace_back(info.name, info.help);
  }
  return list;
}

base::Result<model::Robot> make_robot(const RobotCells& cells, int thread_count) {
  return model::Robot::create({.existing = {cells.existing.begin(), cells.existing.end()},
                               .planned = {cells.planned.begin(), cells.planned.end()},
                               .fixed = {cells.fixed.begin(), cells.fixed.end()},
                               .released = {cells.released.begin(), cells.released.end()},
                               .support_z = cells.support_z,
                               .material = cells.material},
                              thread_count);
}

namespace {

/// Finds the limit load; the elastic forces are the start where they are known and in equilibrium.
limit::LimitLoad find_limit(const model::Robot& robot, const verdict::Assessment& assessment,
                            const CheckOptions& options) {
  const limit::Structure structure = limit::structure_of(robot, options.is_bonded);
  const solver::Equilibrium& equilibrium = assessment.equilibrium;
  std::vector<base::Vec6<double>> forces;
  if (assessment.is_stable && !options.is_bonded && !equilibrium.displacement.empty() &&
      equilibrium.outcome == solver::Outcome::kSettled) {
    forces =
        limit::known_forces(robot, structure, equilibrium.displacement, equilibrium.facet_force);
  }
  return limit::limit_load(structure, {.seconds_max = options.limit_seconds_max,
                                       .thread_count = options.thread_count,
                                       .known_forces = forces,
                                       .progress = options.limit_progress});
}

}  // namespace

CheckResult check(const model::Robot& robot, const CheckOptions& options) {
  using solver::SecondOrderWish;
  HOLDFAST_CHECK(robot.pieces().empty() || !(options.is_proof_wanted || options.is_limit_wanted ||
                                             options.is_deformed_wanted));
  const auto start = std::chrono::steady_clock::now();
  const auto passed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  CheckResult result{.assessment =
                         verdict::assess(robot, {.memory_bytes_max = options.memory_bytes_max,
                                                 .is_bonded = options.is_bonded,
                                                 .thread_count = options.thread_count,
                                                 .second_order = options.is_buckling_wanted
                                                                     ? SecondOrderWish::kFactor
                                                                     : SecondOrderWish::kCheck,
                                                 .progress = options.progress})};
  result.seconds = passed();
  if (options.is_proof_wanted) {
    result.proof = proof::prove(
        robot, result.assessment,
        {.memory_bytes_max = options.memory_bytes_max, .thread_count = options.thread_count});
    proof::apply(robot, *result.proof, result.assessment, options.thread_count);
    result.proof_seconds = passed() - result.seconds;
  }
  if (options.is_limit_wanted) {
    const double before = passed();
    result.limit = find_limit(robot, result.assessment, options);
    result.limit_seconds = passed() - before;
  }
  if (options.is_deformed_wanted) {
    const double before = passed();
    verdict::Deformed deformed =
        verdict::assess_deformed(robot, std::move(result.assessment),
                                 {.factor_max = options.factor_max,
                                  .obstacles = options.obstacles,
                                  .is_bonded = options.is_bonded,
                                  .is_followed_behind = options.is_followed_behind,
                                  .on_state = options.on_deformed_state,
                                  .memory_bytes_max = options.memory_bytes_max,
                                  .thread_count = options.thread_count});
    result.is_deformed = true;
    result.assessment = std::move(deformed.assessment);
    result.deformed = std::move(deformed.path);
    result.deformed_seconds = passed() - before;
  }
  return result;
}

CheckResult check(const Structure& structure, const CheckOptions& options) {
  CheckOptions own = options;
  if (own.obstacles.empty()) {
    own.obstacles = structure.document.extension.obstacles;
  }
  return check(structure.robot, own);
}

std::vector<CheckResult> check_many(std::span<const model::Robot* const> robots,
                                    const CheckOptions& options,
                                    const std::function<void(std::size_t done)>& progress) {
  const std::size_t count = robots.size();
  const bool is_shared = count >= host::Team::kSharedChunkMin;
  CheckOptions one = options;
  one.thread_count = is_shared ? 1 : options.thread_count;
  std::vector<CheckResult> results(count);
  std::atomic<std::size_t> done = 0;
  const std::thread::id caller = std::this_thread::get_id();
  // A robot is as much as a chunk of nodes.
  host::Team team(is_shared ? options.thread_count : 1, count * host::Team::kChunk);
  team.each(count, [&](std::size_t i) {
    host::ask_whether_to_go_on();
    results[i] = check(*robots[i], one);
    ++done;
    if (progress && std::this_thread::get_id() == caller) {
      progress(done);
    }
  });
  if (progress && count > 0) {
    progress(count);
  }
  return results;
}

base::Result<std::string> certificate_text(const Structure& structure, const CheckResult& result) {
  const bool is_there = result.proof && !result.proof->certificate.modules.empty();
  if (!is_there) {
    return base::Error{.code = base::ErrorCode::kBadInput,
                       .message = result.proof
                                      ? "no certificate: " + result.proof->verification.reason
                                      : "no certificate, as no proof was wanted"};
  }
  certificate::Certificate certificate = result.proof->certificate;
  certificate.name = io::one_line(structure.name);
  return certificate::write(certificate);
}

void write_report_json(std::ostream& out, const Structure& structure, const CheckResult& result,
                       const io::ReportOptions& options, const io::MoreKeys& more) {
  io::write_report_json(out, entry_of(structure, result), options, more);
}

std::string report_json(const Structure& structure, const CheckResult& result) {
  return io::write_report_json(entry_of(structure, result));
}

std::string report_text(const Structure& structure, const CheckResult& result,
                        const TextOptions& options) {
  io::ReportEntry entry = entry_of(structure, result);
  if (!options.has_notes) {
    entry.warnings = {};
  }
  return io::write_report_text(entry);
}

std::string picture_svg(const Structure& structure, const CheckResult& result,
                        const io::FigureOptions& figure) {
  return io::write_svg(structure.robot, result.assessment, structure.name,
                       structure.document.extension.obstacles, figure);
}

std::string error_json(const base::Error& error, const io::ReportOrigin& origin) {
  return io::write_error_json(error, origin);
}

std::string describe(const base::Error& error, std::string_view file) {
  std::string line = io::one_line(file);
  for (const std::string& part : {error.where, error.message}) {
    if (!part.empty() && part != file) {
      line += (line.empty() ? "" : ": ") + part;
    }
  }
  return line;
}

}  // namespace holdfast
