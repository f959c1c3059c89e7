// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "reading.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// Warns of attributes that nobody knows and of a cell outside the grid.
template <class Entry>
void warn_of_entry(Reading& reading, const Entry& entry) {
  const base::Cell& cell = entry.cell;
  const auto where = [&] { return fmt::format("module ({},{},{})", cell.x, cell.y, cell.z); };
  for (const auto& attribute : entry.attributes) {
    if (!is_simulation_attribute(attribute.first)) {
      reading.warn(fmt::format("the attribute {} is unknown and kept", excerpt(attribute.first)),
                   where);
    }
  }
  const auto& grid = reading.grid();
  const bool is_outside = grid && (std::min({cell.x, cell.y, cell.z}) < 0 || cell.x >= grid->x ||
                                   cell.y >= grid->y || cell.z >= grid->z);
  if (is_outside) {
    reading.warn(fmt::format("outside gridSize '{},{},{}'", grid->x, grid->y, grid->z), where);
  }
}

}  // namespace

const std::string* find_attribute(const Attributes& attributes, std::string_view name) {
  const auto found =
      std::ranges::find_if(attributes, [&](const auto& entry) { return entry.first == name; });
  return found == attributes.end() ? nullptr : &found->second;
}

void Reading::fail(base::Error error) {
  if (!error_) {
    error_ = std::move(error);
  }
}

void Reading::warn(std::string message, const Where& where) {
  const auto same = std::ranges::find(warnings_, message, &Warning::message);
  if (same != warnings_.end()) {
    ++same->count;
  } else if (warnings_.size() == kWarningCountMax) {
    ++warnings_left_out_;
  } else {
    warnings_.push_back({std::move(message), where()});
  }
}

bool Reading::take_room(std::size_t cell_count, const Where& where) {
  cell_count_ += std::min(cell_count, model::kModuleCountMax + 1);
  if (cell_count_ > model::kModuleCountMax) {
    fail({base::ErrorCode::kBadInput,
          fmt::format("{} cells here make more than the {} that are allowed", cell_count,
                      model::kModuleCountMax),
          where()});
  }
  return !has_failed();
}

void Reading::take_known_answer(KnownAnswer answer, const Where& where) {
  if (!is_known_verdict(answer.verdict)) {
    fail({base::ErrorCode::kBadInput,
          fmt::format("the known verdict is {}, allowed are safe, overload, unstable",
                      excerpt(answer.verdict)),
          where()});
  }
  document.known_answer = std::move(answer);
}

void Reading::read_grid(const Where& where) {
  const std::string* const text = find_attribute(document.world, kGridSize);
  if (text == nullptr) {
    return;
  }
  const auto size = parse_triple<std::int32_t>(*text);
  if (!size || !std::ranges::all_of(*size, [](auto n) { return kGridRange.contains(n); })) {
    fail({base::ErrorCode::kBadInput,
          fmt::format("gridSize is {}, allowed are three integers from {} to {}, such as 8,3,4",
                      excerpt(*text), kGridRange.lowest, kGridRange.highest),
          where()});
    return;
  }
  grid_ = {(*size)[0], (*size)[1], (*size)[2]};
}

base::Result<ReadDocument> Reading::finish() && {
  if (error_) {
    return *error_;
  }
  // Empty steps at the end say nothing; files for VisibleSim have them.
  while (!document.steps.empty() && document.steps.back().empty()) {
    document.steps.pop_back();
  }
  warn_of_content();
  return ReadDocument{std::move(document), warning_texts()};
}

void Reading::warn_of_content() {
  const Where nowhere = [] { return std::string(); };
  for (const auto& parameter : document.parameters) {
    if (!is_solver_parameter(parameter.first)) {
      warn(fmt::format("the parameter {} is unknown and kept", excerpt(parameter.first)), nowhere);
    }
  }
  std::ranges::for_each(document.modules, [&](const auto& entry) { warn_of_entry(*this, entry); });
  for (const Step& step : document.steps) {
    std::ranges::for_each(step, [&](const auto& entry) { warn_of_entry(*this, entry); });
  }
  if (document.steps.size() > 1) {
    warn(fmt::format("{} steps are read, only the first one is checked", document.steps.size()),
         nowhere);
  }
  for (const Element& element : document.scenery) {
    if (element.name == "obstacleList") {
      warn("obstacles are not supported: <obstacleList> is kept, but nothing rests on them",
           nowhere);
    } else if (!is_scenery_element(element.name)) {
      warn(fmt::format("the element {} is unknown and kept", excerpt(element.name)), nowhere);
    }
  }
  for (const Element& target : document.targets) {
    const std::string* const format = find_attribute(target.attributes, "format");
    warn(fmt::format("the target format {} is not supported: the target is kept, not checked",
                     format == nullptr ? "''" : excerpt(*format)),
         nowhere);
  }
}

std::vector<std::string> Reading::warning_texts() const {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings_) {
    texts.push_back(
        fmt::format("{}{}{}", warning.where, warning.where.empty() ? "" : ": ", warning.message));
    if (warning.count > 1) {
      texts.back() += fmt::format(" ({} times, first here)", warning.count);
    }
  }
  if (warnings_left_out_ > 0) {
    texts.push_back(fmt::format("{} further warnings are left out", warnings_left_out_));
  }
  return texts;
}

}  // namespace holdfast::io
