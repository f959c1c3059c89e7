// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/wire/wire.hpp"

/// One face's serial link made reliable: messages arrive once, whole and in order, or the link is
/// lost and says so.
///
/// Both ends greet each other with fresh random numbers (a session); the checksum of every later
/// packet starts from them, so that packets of an earlier session, or of another neighbour, fail
/// it. A neighbour that has fallen silent is greeted every `ping_after`, so that both sides find
/// each other when it comes back. Packets carry a 6-bit sequence number and acknowledge what has
/// come the other way; at most kWindow of them are under way, or kLentWindow, and all are sent
/// again when no acknowledgement comes in time (go-back-N). An acknowledgement waits a little for
/// data to ride on.
namespace holdfast::agent {

/// Time in the port's unit, for instance microseconds; only differences and order matter.
using Time = std::uint64_t;

inline constexpr Time kNever = ~Time{0};

struct LinkTiming {
  int packet_bytes = wire::kPacketBytesMin;    ///< kPacketBytesMin to kPacketBytesMax.
  std::uint8_t lattice = wire::kCubicLattice;  ///< That greetings name; here, as there is room.
  Time acknowledge_after = 8'000;
  Time retransmit_after = 50'000;  ///< Longer than two packets and acknowledge_after.
  int retry_count = 4;             ///< At this pace; later ones wait twice as long each, up to 8x.
  int lost_after_retries = 20;     ///< Then the neighbour counts as silent.
  Time ping_after = 2'000'000;     ///< Silence that is borne while waiting for the neighbour.
};

/// How long the first packet that nobody acknowledges is under way before the link is lost.
Time lost_after(const LinkTiming& timing);

class Link {
 public:
  enum class State : std::uint8_t { kDown, kGreeting, kOpen, kLost };

  static constexpr int kWindow = 4;
  /// Bytes that can wait to be sent or acknowledged: a whole sweep of the largest messages.
  static constexpr int kQueueBytes = 320;
  /// The window of a link whose queue is lent: long streams wait for acknowledgements less often.
  static constexpr int kLentWindow = 16;
  /// What is lent for a longer queue: a window of the largest packets and more, and their sizes.
  static constexpr int kLentBytes = 4096;
  /// Bytes of a queue where there may be many planned modules: all vectors of an iteration, and
  /// more.
  static constexpr int kPlannedBytes = 4096;

  /// A neighbour is there. `nonce` should differ each time. 0 and the last one are never used, the
  /// next number is; if it is that of a session before this object was made, which the neighbour
  /// still believes in, the first greetings tell, and the next number is used as well.
  void bring_up(std::uint16_t nonce, Time now);

  void bring_down();

  /// Says before it comes up which face of the module it is at, as greetings do; else it is +x.
  void set_face(base::Direction face) { face_ = face; }

  /// Has the neighbour greeted from another face than the one opposite this one? It is turned, or
  /// the cable is in a wrong place; the link works all the same.
  bool has_mismatch() const { return has_mismatch_; }

  /// A longer queue, kLentBytes; while the link is down. Who has one has long streams, and
  /// acknowledges every second packet that is full at once.
  void lend(std::uint8_t* queue) { lent_ = queue; }

  /// Lends a queue of kPlannedBytes.
  void lend_long(std::uint8_t* queue) {
    lent_ = queue;
    is_long_ = true;
  }

  /// The neighbour has said what it must not: it counts as silent, and is not listened to any more.
  void lose();

  State state() const { return state_; }

  bool is_used() const { return state_ == State::kGreeting || state_ == State::kOpen; }

  /// Queues a message. On a link that is not used it is dropped. False: the queue is full.
  [[nodiscard]] bool send(std::span<const std::uint8_t> message);

  /// Can a message of so many bytes be queued?
  bool has_room(int bytes) const {
    return queued_bytes_ + bytes <= (is_long() ? kPlannedBytes - kLentWindow : kQueueBytes);
  }

  /// Can so many bytes of a long stream be queued, which may use a queue that is lent?
  bool has_long_room(int bytes) const { return queued_bytes_ + bytes <= capacity(); }

  /// Forgets queued messages of which no byte has been sent.
  void drop_unsent();

  /// Takes in a packet. Returns the new part of the neighbour's stream, a view into `packet`;
  /// empty if it brings nothing new or is not valid.
  std::span<const std::uint8_t> receive(std::span<const std::uint8_t> packet,
                                        const LinkTiming& timing, Time now);

  /// Moves bytes from the front of `stream` until a message is complete; returns it, valid until
  /// the next call. Empty: more is needed. Bytes that are no message make the link lost.
  std::span<const std::uint8_t> next_message(std::span<const std::uint8_t>& stream);

  /// The neighbour has greeted with another number: it has started again; or it was silent, and is
  /// heard again. Says so once.
  bool take_restarted();

  /// Is there a packet to send now?
  bool has_packet(Time now) const;

  /// Writes it and returns its size, 0 if there is none.
  int write_packet(std::span<std::uint8_t> packet, const LinkTiming& timing, Time now);

  /// Handles what is due; while `is_watched`, a silent neighbour is pinged.
  void on_time(const LinkTiming& timing, bool is_watched, Time now);

  /// When on_time() must be called at the latest.
  Time deadline(const LinkTiming& timing, bool is_watched) const;

 private:
  std::span<const std::uint8_t> receive_greeting(std::span<const std::uint8_t> body,
                                                 const LinkTiming& timing);
  void receive_acknowledgement(std::uint8_t next, const LinkTiming& timing, Time now);
  int write_greeting(std::span<std::uint8_t> packet, const LinkTiming& timing, Time now);
  std::uint8_t* queue();
  int capacity() const;
  int window() const;
  std::uint8_t& chunk_bytes(int index);
  void clear();
  std::uint16_t wrapped(int position) const;
  int packet_chunk(const LinkTiming& timing);
  Time patience(const LinkTiming& timing) const;

  /// Is a neighbour greeted that has fallen silent?
  bool is_calling() const { return state_ == State::kLost && retry_at_ != kNever; }

  bool is_long() const { return is_long_; }

  State state_ = State::kDown;
  bool needs_greeting_ = false;
  bool needs_ping_ = false;
  bool is_restarted_ = false;
  base::Direction face_ = base::Direction::kPlusX;
  bool has_mismatch_ = false;
  std::uint16_t nonce_ = 0;
  std::uint16_t peer_nonce_ = 0;

  // Sending: a ring of stream bytes. [head, cursor) is under way, [cursor, tail) waits.
  std::array<std::uint8_t, kQueueBytes> queue_{};
  std::uint16_t head_ = 0;
  std::uint16_t sent_bytes_ = 0;      ///< From head to cursor.
  std::uint16_t queued_bytes_ = 0;    ///< From head to tail.
  std::uint16_t message_left_ = 0;    ///< Bytes after the furthest byte sent that end its message.
  std::uint16_t furthest_bytes_ = 0;  ///< From head to the furthest byte ever sent.
  std::array<std::uint8_t, kWindow> chunk_bytes_{};
  std::uint8_t sent_count_ = 0;   ///< Packets under way.
  std::uint8_t known_count_ = 0;  ///< Packets whose size is fixed as they have been sent before.
  std::uint8_t send_number_ = 0;  ///< Sequence number of the packet at head.
  std::uint8_t retry_count_ = 0;
  std::uint8_t receive_number_ = 0;  // Beside them, as there is room.
  bool owes_acknowledgement_ = false;

  // Receiving, bytes first, so that no room is lost.
  std::array<std::uint8_t, wire::kMessageBytesMax> message_{};
  std::uint8_t message_bytes_ = 0;  ///< Here so far, ...
  std::uint8_t message_size_ = 0;   ///< ... of so many.
  /// What is lent has kPlannedBytes.
  [[no_unique_address]] PresentIf<kIsGeneral, bool> is_long_ = false;
  Time acknowledge_at_ = kNever;
  Time heard_at_ = 0;

  Time retry_at_ = kNever;        ///< On a lost link: of the next greeting.
  std::uint8_t* lent_ = nullptr;  ///< Not owned; in place of queue_.
};

}  // namespace holdfast::agent
