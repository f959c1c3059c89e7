// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>

#include "holdfast/io/move_report.hpp"

namespace holdfast::io {

base::Result<Document> after_moves(Document document, std::span<const model::Step> steps) {
  std::map<base::Cell, base::Cell> first_cell;  // Of the module that is in a cell now.
  for (const ModuleEntry& module : document.modules) {
    first_cell.emplace(module.cell, module.cell);
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const model::Move& move : steps[i].moves) {
      auto module = first_cell.extract(move.from);
      if (module.empty() || first_cell.contains(move.to)) {
        return base::bad_input(fmt::format(
            "step {} moves a module from {} to {}, where {}", i, model::text(move.from),
            model::text(move.to), module.empty() ? "it begins without one" : "one is already"));
      }
      module.key() = move.to;
      first_cell.insert(std::move(module));
    }
  }
  std::map<base::Cell, base::Cell> last_cell;
  for (const auto& [last, first] : first_cell) {
    last_cell.emplace(first, last);
  }
  for (ModuleEntry& module : document.modules) {
    module.cell = last_cell.at(module.cell);
  }
  for (model::Payload& payload : document.extension.payloads) {
    const auto found = last_cell.find(payload.cell);
    payload.cell = found == last_cell.end() ? payload.cell : found->second;
  }
  document.extension.plan.clear();
  document.known_answer.reset();
  return document;
}

}  // namespace holdfast::io
