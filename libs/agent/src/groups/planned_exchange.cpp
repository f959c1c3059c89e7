// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/groups/planned_exchange.hpp"

#include "algebra/scalar.hpp"
#include "holdfast/agent/messages/messages.hpp"

namespace holdfast::agent {

void PlannedExchange::enter() {
  here_ = {};
  forces_awaited_ = 0;
}

void PlannedExchange::share(Links& links, Faces children, const Planned& planned, int index,
                            const base::Vec6<float>& vector) {
  if (is_own(index)) {
    vector_[at(index)] = vector;
  } else {
    planned.more_planned()->vector[more_at(index)] = vector;
  }
  send_down(links, children, planned, static_cast<std::uint8_t>(index), vector);
}

void PlannedExchange::take_down(Links& links, Faces children, const Planned& planned,
                                std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  note_here(in.label);
  share(links, children, planned, in.label, in.vector);
}

void PlannedExchange::send_down(Links& links, Faces children, const Planned& planned,
                                std::uint8_t label, const base::Vec6<float>& vector) {
  for (const Direction face : children) {
    if (planned.is_needed_below(face, label & kPlannedIndexMask)) {
      links.send(Faces::only(face), vector_message(wire::MessageType::kPlannedDown, label, vector));
    }
  }
}

void PlannedExchange::send_up(Links& links, Faces parent, const Planned& planned, bool is_precise) {
  for (int k = 0; k < planned.count(); ++k) {
    if (!planned.is_from_above(k)) {
      continue;
    }
    base::Vec6<double>& rest = force(planned, k);
    const int parts = is_precise ? 2 : 1;
    for (int part = 0; part < parts; ++part) {
      base::Vec6<double> leading = rest;
      for (std::size_t i = 0; i < 6; ++i) {
        leading[i] = part + 1 < parts ? leading_part(rest[i]) : rest[i];
        rest[i] -= leading[i];
      }
      links.send(parent, vector_message(wire::MessageType::kPlannedUp, static_cast<std::uint8_t>(k),
                                        base::converted<float>(leading)));
    }
  }
}

bool PlannedExchange::take_up(const Planned& planned, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  add_force(planned, in.label, base::converted<double>(in.vector));
  return awaits_forces() && --forces_awaited_ == 0;
}

}  // namespace holdfast::agent
