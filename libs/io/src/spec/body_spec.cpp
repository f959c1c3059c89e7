// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "spec/body_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "holdfast/model/connected_parts.hpp"
#include "json/json_values.hpp"
#include "spec/connection_spec.hpp"

namespace holdfast::io {
namespace {

using base::Cell;
using Fault = std::optional<base::Error>;

Fault fault_at(const JsonPlace& place, std::string message) {
  return base::bad_input(std::move(message), place.pointer());
}

/// Finds a cell that is not joined to the first one by faces of the body's own modules.
std::optional<Cell> find_apart(const std::vector<Cell>& body, const base::Lattice& lattice) {
  std::map<Cell, std::int32_t> index;
  for (const Cell& cell : body) {
    index.emplace(cell, static_cast<std::int32_t>(index.size()));
  }
  model::ConnectedParts parts(body.size());
  for (const Cell& cell : body) {
    for (const base::Direction direction : base::directions(lattice)) {
      const auto beside = index.find(base::neighbour(lattice, cell, direction));
      if (beside != index.end()) {
        parts.join(index.at(cell), beside->second);
      }
    }
  }
  const std::int32_t first = parts.first_of(0);
  const auto apart = std::ranges::find_if(
      body, [&](const Cell& cell) { return parts.first_of(index.at(cell)) != first; });
  return apart == body.end() ? std::nullopt : std::optional(*apart);
}

/// Follows which bodies are there, step by step.
class BodyWalk {
 public:
  explicit BodyWalk(const Document& document) : document_(document), index_(document) {}

  Fault walk() {
    std::vector<Cell> cells;
    std::ranges::transform(document_.modules, std::back_inserter(cells), &ModuleEntry::cell);
    if (Fault fault = arrive(cells, "the start")) {
      return fault;
    }
    const std::size_t first = first_step(document_);
    for (std::size_t i = first; i < document_.steps.size(); ++i) {
      cells.clear();
      std::ranges::transform(document_.steps[i], std::back_inserter(cells), &PlannedEntry::cell);
      if (Fault fault = arrive(cells, fmt::format("step {}", i - first))) {
        return fault;
      }
    }
    for (std::size_t i = 0; i < document_.extension.plan.size(); ++i) {
      const std::size_t number = document_.steps.size() - first + i;
      if (Fault fault = take(document_.extension.plan[i], number)) {
        return fault;
      }
    }
    return std::nullopt;
  }

 private:
  Fault take(const model::Step& step, std::size_t number) {
    const JsonPlace top;
    const JsonPlace steps = top.at("steps");
    const std::string words = fmt::format("step {}", number);
    for (const auto* const pairs : {&step.release, &step.connect}) {
      for (const model::CellPair& pair : *pairs) {
        const auto body = index_.inside(pair);
        if (body && present_.contains(*body)) {
          return fault_at(
              steps, fmt::format("{} names {}-{}, which is inside body {} and never parts", words,
                                 model::text(pair[0]), model::text(pair[1]), *body));
        }
      }
    }
    for (const model::Move& move : step.moves) {
      if (const auto body = present_at(move.from)) {
        return fault_at(steps,
                        fmt::format("{} moves {} of body {}, expected modules of none: bodies "
                                    "come and go, they do not move",
                                    words, model::text(move.from), *body));
      }
    }
    if (Fault fault = leave(step, words)) {
      return fault;
    }
    std::vector<Cell> cells = step.attach;
    std::ranges::transform(step.moves, std::back_inserter(cells), &model::Move::to);
    return arrive(cells, words, step.is_any_order);
  }

  std::optional<std::int32_t> present_at(const Cell& cell) const {
    const auto body = index_.body_at(cell);
    return body && present_.contains(*body) ? body : std::nullopt;
  }

  Fault leave(const model::Step& step, const std::string& words) {
    const std::set<Cell> gone(step.detach.begin(), step.detach.end());
    for (const Cell& cell : step.detach) {
      const auto body = present_at(cell);
      if (!body) {
        continue;
      }
      if (Fault fault = expect_whole(*body, gone, words, "detaches", step.is_any_order)) {
        return fault;
      }
    }
    std::erase_if(present_, [&](std::int32_t body) {
      return gone.contains(document_.extension.bodies[base::at(body)].front());
    });
    return std::nullopt;
  }

  Fault arrive(const std::vector<Cell>& cells, const std::string& words,
               bool is_any_order = false) {
    std::set<Cell> fresh;
    for (const Cell& cell : cells) {
      if (index_.body_at(cell) && !seen_.contains(cell)) {
        fresh.insert(cell);
      }
    }
    seen_.insert(fresh.begin(), fresh.end());
    for (const Cell& cell : fresh) {
      const std::int32_t body = *index_.body_at(cell);
      if (Fault fault = expect_whole(body, fresh, words, "has", is_any_order)) {
        return fault;
      }
      present_.insert(body);
    }
    return std::nullopt;
  }

  Fault expect_whole(std::int32_t body, const std::set<Cell>& cells, const std::string& words,
                     std::string_view does, bool is_any_order) const {
    const std::vector<Cell>& all = document_.extension.bodies[base::at(body)];
    const auto there =
        std::ranges::find_if(all, [&](const Cell& cell) { return cells.contains(cell); });
    const auto missing =
        std::ranges::find_if(all, [&](const Cell& cell) { return !cells.contains(cell); });
    const JsonPlace top;
    const JsonPlace bodies = top.at("bodies");
    if (missing != all.end()) {
      return fault_at(
          bodies.at(base::at(body)),
          fmt::format("{} {} {} of body {}, but not {}: a body comes and goes as a whole", words,
                      does, model::text(*there), body, model::text(*missing)));
    }
    if (is_any_order && all.size() > 1) {
      return fault_at(
          bodies.at(base::at(body)),
          fmt::format("{} has body {} and is marked \"any_order\": the modules of a body "
                      "come and go at one instant",
                      words, body));
    }
    return std::nullopt;
  }

  const Document& document_;
  BodyIndex index_;
  std::set<Cell> seen_;             ///< Cells of bodies in which a module has been.
  std::set<std::int32_t> present_;  ///< Bodies that are there.
};

}  // namespace

BodyIndex::BodyIndex(const Document& document) {
  std::int32_t number = 0;
  for (const std::vector<Cell>& body : document.extension.bodies) {
    for (const Cell& cell : body) {
      bodies_.emplace(cell, number);
    }
    ++number;
  }
}

std::optional<std::int32_t> BodyIndex::inside(const model::CellPair& pair) const {
  const auto body = body_at(pair[0]);
  return body && body == body_at(pair[1]) ? body : std::nullopt;
}

std::optional<std::int32_t> BodyIndex::body_at(const Cell& cell) const {
  const auto found = bodies_.find(cell);
  return found == bodies_.end() ? std::nullopt : std::optional(found->second);
}

Fault find_bodies_fault(const Document& document) {
  const JsonPlace top;
  const JsonPlace place = top.at("bodies");
  const std::set<Cell> modules = cells_of(document);
  std::map<Cell, std::size_t> taken;
  const auto& bodies = document.extension.bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].empty()) {
      return fault_at(place.at(i), "expected at least one cell, found an empty array");
    }
    for (const Cell& cell : bodies[i]) {
      const std::string text = model::text(cell);
      const auto [found, is_new] = taken.emplace(cell, i);
      if (!is_new) {
        return fault_at(place.at(i),
                        found->second == i
                            ? fmt::format("the cell {} is named twice, expected once", text)
                            : fmt::format("the cell {} is in body {} as well, expected "
                                          "one body",
                                          text, found->second));
      }
      if (!modules.contains(cell)) {
        return fault_at(place.at(i), fmt::format("expected modules, found none at {}", text));
      }
    }
    if (const auto apart = find_apart(bodies[i], document.extension.lattice)) {
      return fault_at(
          place.at(i),
          fmt::format("no faces of its own cells join {} and {}, expected a body in one "
                      "part",
                      model::text(bodies[i].front()), model::text(*apart)));
    }
  }
  return bodies.empty() ? std::nullopt : BodyWalk(document).walk();
}

}  // namespace holdfast::io
