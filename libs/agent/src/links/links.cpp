// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/links/links.hpp"

#include <cstddef>

namespace holdfast::agent {

Faces Links::working() const {
  Faces faces;
  for (const Direction face : base::kDirections) {
    faces.set(face, is_used(face));
  }
  for (const Direction face : all() - Faces::all()) {
    faces.set(face, is_used(face));
  }
  return faces;
}

bool Links::has_mismatch() const {
  for (const Direction face : all()) {
    if (at(face).has_mismatch()) {
      return true;
    }
  }
  return false;
}

void Links::send(Faces faces, const wire::Writer& message) {
  for (const Direction face : faces) {
    touched_.add(face);
    if (!at(face).send(message.bytes())) {
      silent_.add(face);
      has_refused_ = true;
    }
  }
}

void Links::lend(MoreFaces* more) {
  more_ = more;
  more->deadline.fill(kNever);
}

void Links::lend(std::uint8_t* queues) {
  for (const Direction face : directions(more())) {
    at(face).lend(queues + static_cast<std::ptrdiff_t>(face) * Link::kLentBytes);
  }
}

void Links::lend_long(std::uint8_t* queues) {
  for (const Direction face : directions(more())) {
    at(face).lend_long(queues + static_cast<std::ptrdiff_t>(face) * Link::kPlannedBytes);
  }
}

bool Links::take_refusal() {
  const bool has_refused = has_refused_;
  has_refused_ = false;
  return has_refused;
}

void Links::bring_up(Direction face, std::uint16_t nonce, Time now) {
  at(face).set_face(face);
  at(face).bring_up(nonce, now);
  silent_.remove(face);
  touched_.add(face);
}

void Links::bring_down(Direction face) {
  at(face).bring_down();
  silent_.remove(face);
  touched_.add(face);
}

void Links::count_if_lost(Direction face) {
  if (at(face).state() == Link::State::kLost && refused_count_ < 0xff) {
    ++refused_count_;
  }
}

std::span<const std::uint8_t> Links::receive(Direction face, std::span<const std::uint8_t> packet,
                                             const Clock& clock) {
  touched_.add(face);
  return at(face).receive(packet, clock.timing, clock.now);
}

bool Links::notice_change(Direction face, std::uint16_t nonce, Time now) {
  Link& link = at(face);
  const bool has_restarted = link.take_restarted();
  if (has_restarted) {
    link.bring_up(nonce, now);
    silent_.remove(face);
  }
  const bool falls_silent = link.state() == Link::State::kLost && !silent_.has(face);
  if (falls_silent) {
    silent_.add(face);
  }
  return has_restarted || falls_silent;
}

int Links::write_packet(Direction face, std::span<std::uint8_t> packet, const Clock& clock) {
  touched_.add(face);
  return at(face).write_packet(packet, clock.timing, clock.now);
}

Faces Links::due(Time now) const {
  Faces faces;
  for (const Direction face : base::kDirections) {
    faces.set(face, deadline_at(face) <= now);
  }
  for (const Direction face : all() - Faces::all()) {
    faces.set(face, deadline_at(face) <= now);
  }
  return faces;
}

void Links::on_time(Direction face, const Clock& clock, bool is_watched) {
  touched_.add(face);
  at(face).on_time(clock.timing, is_watched, clock.now);
}

void Links::drop_unsent() {
  for (const Direction face : all()) {
    at(face).drop_unsent();
  }
  touch_all();
}

void Links::finish_step(const Clock& clock, bool is_watched) {
  for (const Direction face : touched_) {
    waiting_.set(face, at(face).has_packet(clock.now));
    deadline_at(face) = at(face).deadline(clock.timing, is_watched);
  }
  touched_ = {};
}

Time Links::deadline(Faces faces) const {
  Time earliest = kNever;
  for (const Direction face : faces) {
    const Time at = deadline_at(face);
    earliest = at < earliest ? at : earliest;
  }
  return earliest;
}

}  // namespace holdfast::agent
