// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/steps.hpp"

#include <chrono>
#include <utility>

namespace holdfast {
namespace {

io::StepsEntry entry_of(const StepsFile& file, const StepsResult& result) {
  return {.name = file.name,
          .document = &file.document,
          .judgement = &result.judgement,
          .warnings = file.warnings,
          .seconds = result.seconds};
}

}  // namespace

base::Result<StepsFile> load_steps(const std::filesystem::path& path,
                                   const io::ReadOptions& options) {
  const auto text = read_file(path);
  if (!text) {
    return text.error();
  }
  auto read = io::read_document(text.value(), options);
  if (!read) {
    return read.error();
  }
  auto [document, warnings] = std::move(read).value();
  if (io::step_count(document) == 0) {
    return base::Error{.code = base::ErrorCode::kBadInput,
                       .message = "the structure has no steps; holdfast check judges it as it is",
                       .where = "/steps"};
  }
  std::string name = document.name.empty() ? path.stem().string() : document.name;
  return StepsFile{
      .name = std::move(name), .document = std::move(document), .warnings = std::move(warnings)};
}

base::Result<StepsResult> judge_steps(const StepsFile& file, const StepsOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto sequence = io::make_sequence(file.document);
  if (!sequence) {
    return sequence.error();
  }
  plan::SequenceOptions more{.ends_when_unsafe = options.ends_when_unsafe,
                             .progress = options.progress};
  more.solver.thread_count = options.thread_count;
  more.solver.memory_bytes_max = options.memory_bytes_max;
  auto judged = plan::judge_sequence(sequence.value().start, sequence.value().steps, more);
  if (!judged) {
    base::Error error = judged.error();
    if (!error.where.empty()) {
      error.where = io::step_pointer(file.document, std::stoul(error.where));
    }
    return error;
  }
  StepsResult result{.judgement = std::move(judged).value()};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

void write_steps_json(std::ostream& out, const StepsFile& file, const StepsResult& result) {
  io::write_steps_json(out, entry_of(file, result));
}

std::string steps_text(const StepsFile& file, const StepsResult& result) {
  return io::write_steps_text(entry_of(file, result));
}

}  // namespace holdfast
