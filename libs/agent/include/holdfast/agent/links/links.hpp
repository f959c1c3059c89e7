// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/links/more_faces.hpp"
#include "holdfast/agent/wire/link.hpp"

/// The links of a module, six of them or more: who is there, who has fallen silent, and when they
/// have to be looked after.
namespace holdfast::agent {

using base::Direction;

/// What a module knows of time in a step.
struct Clock {
  const LinkTiming& timing;
  Time now = 0;
};

class Links {
 public:
  Links() { deadline_.fill(kNever); }

  /// Lends a module that is no cube the memory for its other faces. Once, before any link is up.
  void lend(MoreFaces* more);

  /// Is null if the module is a cube.
  MoreFaces* more() const { return more_; }

  /// All faces of the module.
  Faces all() const { return all_faces(more()); }

  /// Faces whose link is used: a neighbour is there and answers, and it is not hidden.
  Faces used() const { return working() - hidden_; }

  /// Faces whose link is used, hidden ones with them.
  Faces working() const;

  /// Links that have no part in the round, though they work: their connections are off in the stage
  /// that is judged.
  Faces hidden() const { return hidden_; }

  void hide(Faces faces) { hidden_ = faces; }

  /// Faces of neighbours that ought to answer and do not.
  Faces silent() const { return silent_; }

  /// Is a face of this module connected with one that does not look at it? Known of every neighbour
  /// that has said anything.
  bool has_mismatch() const;

  bool is_used(Direction face) const { return at(face).is_used(); }

  /// Queues a message on every one of `faces`. A neighbour that does not take what it is sent is as
  /// good as silent.
  void send(Faces faces, const wire::Writer& message);

  /// Can a message of so many bytes be queued on the link of `face`?
  bool has_room(Direction face, int bytes) const { return at(face).has_room(bytes); }

  bool has_long_room(Direction face, int bytes) const { return at(face).has_long_room(bytes); }

  /// Lends every link a longer queue, `face` times Link::kLentBytes from here.
  void lend(std::uint8_t* queues);

  /// Lends longer ones for all faces there may be, `face` times Link::kPlannedBytes from here.
  void lend_long(std::uint8_t* queues);

  /// Has a neighbour fallen silent by what was sent since the last call?
  bool take_refusal();

  void bring_up(Direction face, std::uint16_t nonce, Time now);
  void bring_down(Direction face);

  /// The neighbour at `face` has said what a working one would not: its link is lost.
  void refuse(Direction face) { at(face).lose(); }

  /// Counts a packet on a link that was used if it has lost the link, whether by a
  /// refused message, by bytes that are none, or by a greeting from another lattice.
  void count_if_lost(Direction face);

  /// Packets that have lost a link, 255 at most.
  std::uint8_t refused_count() const { return refused_count_; }

  /// Takes in a packet; next_message() takes the stream that it returns apart (see Link).
  std::span<const std::uint8_t> receive(Direction face, std::span<const std::uint8_t> packet,
                                        const Clock& clock);

  std::span<const std::uint8_t> next_message(Direction face,
                                             std::span<const std::uint8_t>& stream) {
    return at(face).next_message(stream);
  }

  /// Has the neighbour at `face` started again, or just fallen silent? Greets it in the first case
  /// with `nonce`.
  bool notice_change(Direction face, std::uint16_t nonce, Time now);

  int write_packet(Direction face, std::span<std::uint8_t> packet, const Clock& clock);

  /// Faces whose link has to be looked after now: hand them to on_time().
  Faces due(Time now) const;
  void on_time(Direction face, const Clock& clock, bool is_watched);

  void drop_unsent();

  /// All deadlines are found anew in finish_step(): whether links are watched has changed.
  void touch_all() { touched_ = all(); }

  /// Finds out at the end of a step which links have a packet to send, and their deadlines.
  void finish_step(const Clock& clock, bool is_watched);

  /// Faces on which a packet waits, as finish_step() has found.
  Faces waiting() const { return waiting_; }

  /// When a link has to be looked after at the latest.
  Time deadline(Faces faces) const;

  /// When any link has to be looked after, as is asked after every step.
  Time deadline() const {
    const Time own = earliest(deadline_);
    const Time lent = more() == nullptr ? kNever : earliest(more()->deadline);
    return lent < own ? lent : own;
  }

 private:
  Link& at(Direction face) { return at_face(links_, more(), &MoreFaces::links, face); }

  const Link& at(Direction face) const { return at_face(links_, more(), &MoreFaces::links, face); }

  static Time earliest(const ByFace<Time>& deadlines) {
    Time earliest = kNever;
    for (const Time at : deadlines) {
      earliest = at < earliest ? at : earliest;
    }
    return earliest;
  }

  Time& deadline_at(Direction face) {
    return at_face(deadline_, more(), &MoreFaces::deadline, face);
  }

  Time deadline_at(Direction face) const {
    return at_face(deadline_, more(), &MoreFaces::deadline, face);
  }

  [[no_unique_address]] PresentIf<kIsGeneral, MoreFaces*> more_ = nullptr;  ///< Not owned.
  ByFace<Link> links_;
  ByFace<Time> deadline_{};
  Faces touched_;  ///< Whose link has changed in this step.
  Faces waiting_;
  Faces silent_;
  Faces hidden_;
  bool has_refused_ = false;  ///< A neighbour has not taken a message.
  std::uint8_t refused_count_ = 0;
};

}  // namespace holdfast::agent
