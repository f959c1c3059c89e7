// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/steps.hpp"

#include <chrono>
#include <span>
#include <utility>
#include <vector>

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
  plan::SequenceOptions more;
  more.ends_when_unsafe = options.ends_when_unsafe;
  more.progress = options.progress;
  more.solver.thread_count = options.thread_count;
  more.solver.memory_bytes_max = options.memory_bytes_max;
  auto judged = plan::judge_sequence(sequence.value().start, sequence.value().steps, more);
  if (!judged) {
    base::Error error = judged.error();
    if (!error.where.empty()) {
      error.where = io::step_pointer(file.document, std::stoul(error.where));
    }
    return io::with_other_lattice(std::move(error), file.document);
  }
  StepsResult result{.judgement = std::move(judged).value()};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

void write_steps_json(std::ostream& out, const StepsFile& file, const StepsResult& result) {
  io::write_steps_json(out, entry_of(file, result));
}

std::string steps_svg(const StepsFile& file, const StepsResult& result,
                      const io::FigureOptions& figure) {
  return io::write_steps_svg(entry_of(file, result), figure);
}

std::string steps_html(const StepsFile& file, const StepsResult& result) {
  return io::write_steps_html(entry_of(file, result));
}

namespace {

/// Writes one state after another, and remembers what belongs into the .pvd file.
class Series {
 public:
  Series(std::filesystem::path path, const StepsOptions& options)
      : path_(std::move(path)), options_(options) {}

  /// The robots of one time.
  std::optional<base::Error> add(std::span<const model::RobotSpec> pieces) {
    for (std::size_t part = 0; part < pieces.size(); ++part) {
      const auto robot = model::Robot::create(pieces[part], options_.thread_count);
      if (!robot) {
        return robot.error();
      }
      std::string name = path_.stem().string() + "_" + std::to_string(time_);
      name += (pieces.size() > 1 ? "_" + std::to_string(part) : "") + ".vtu";
      const CheckResult checked = check(
          robot.value(),
          {.thread_count = options_.thread_count, .memory_bytes_max = options_.memory_bytes_max});
      const auto error = write_file(path_.parent_path() / name, [&](std::ostream& out) {
        io::write_vtu(out, robot.value(), checked.assessment, {}, pieces[part].obstacles);
      });
      if (error) {
        return error;
      }
      files_.push_back({.time = time_, .part = part, .name = std::move(name)});
    }
    ++time_;
    return std::nullopt;
  }

  std::optional<base::Error> finish() const {
    return write_file(path_, [this](std::ostream& out) { io::write_pvd(out, files_); });
  }

 private:
  std::filesystem::path path_;
  const StepsOptions& options_;
  std::size_t time_ = 0;
  std::vector<io::SeriesFile> files_;
};

}  // namespace

std::optional<base::Error> write_steps_vtk(const std::filesystem::path& path, const StepsFile& file,
                                           const StepsResult& result, const StepsOptions& options) {
  const auto sequence = io::make_sequence(file.document);
  if (!sequence) {
    return sequence.error();
  }
  const std::string name = path.stem().string();
  if (io::one_line(name) != name) {
    return base::Error{.code = base::ErrorCode::kBadInput,
                       .message =
                           "names of .vtu files are written into the .pvd file, expected "
                           "UTF-8 without control characters"};
  }
  plan::RobotState robot(sequence.value().start);
  Series series(path, options);
  const std::vector<model::RobotSpec> start = {sequence.value().start};
  auto error = series.add(start);
  for (std::size_t i = 0; i < result.judgement.steps.size() && !error; ++i) {
    const model::Step& step = sequence.value().steps[i];
    const auto transition = plan::find_transition(robot, step);
    const auto scenes =
        transition ? plan::find_scenes(robot, step, transition.value(), plan::Stage::kConnect)
                   : base::Result<std::vector<plan::Scene>>(transition.error());
    if (!scenes) {
      return scenes.error();
    }
    error = series.add(scenes.value().front().pieces);
    plan::apply(step, transition.value(), robot);
    if (options.progress) {
      options.progress(i + 1);
    }
  }
  return error ? error : series.finish();
}

std::string steps_text(const StepsFile& file, const StepsResult& result) {
  return io::write_steps_text(entry_of(file, result));
}

}  // namespace holdfast
