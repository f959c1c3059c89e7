// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/wire/link.hpp"

#include <bit>
#include <cstring>

#include "holdfast/agent/features.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::agent {
namespace {

using wire::PacketKind;

constexpr std::uint8_t kNumberMask = 0x3f;
constexpr std::uint16_t kGreetingChecksum = 0xffff;
constexpr int kGreetingBytes = 6;
/// Bits of the lattice in a greeting's last byte; above them is the face.
constexpr unsigned kLatticeBits = 2;

std::uint8_t header(std::uint8_t top, std::uint8_t number) {
  return static_cast<std::uint8_t>((top << 6U) | (number & kNumberMask));
}

/// Where the checksum of a session starts. Of even parity, as the start for greetings: then no odd
/// number of flipped bits turns a packet of one into one of the other.
std::uint16_t session(std::uint16_t sender, std::uint16_t receiver) {
  const auto mixed = static_cast<std::uint16_t>(sender ^ std::rotl(receiver, 5));
  std::uint32_t parity = mixed;
  for (const unsigned half : {8U, 4U, 2U, 1U}) {
    parity ^= parity >> half;
  }
  return static_cast<std::uint16_t>(mixed ^ (parity & 1U));
}

/// What the modules are, as greetings say it.
std::uint8_t lattice_of(const LinkTiming& timing) {
  return kIsGeneral ? timing.lattice : wire::kCubicLattice;
}

int finish(std::span<std::uint8_t> packet, int size, std::uint16_t start) {
  const auto body = static_cast<std::size_t>(size);
  const std::uint16_t sum = wire::checksum(packet.first(body), start);
  packet[body] = static_cast<std::uint8_t>(sum & 0xffU);
  packet[body + 1] = static_cast<std::uint8_t>(sum >> 8U);
  return size + wire::kChecksumBytes;
}

/// How long to wait for an answer: the first retries come at an even pace.
Time patience_of(const LinkTiming& timing, int retry_count) {
  const int extra = retry_count > timing.retry_count ? retry_count - timing.retry_count : 0;
  return timing.retransmit_after << static_cast<unsigned>(extra < 3 ? extra : 3);
}

}  // namespace

Time lost_after(const LinkTiming& timing) {
  Time sum = 0;
  for (int retry_count = 0; retry_count <= timing.lost_after_retries; ++retry_count) {
    sum += patience_of(timing, retry_count);
  }
  return sum;
}

// Constants where no queue is ever lent.

std::uint8_t* Link::queue() {
  return (kHasAllMethods || is_long()) && lent_ != nullptr ? lent_ : queue_.data();
}

int Link::capacity() const {
  if (is_long()) {
    return kPlannedBytes - kLentWindow;
  }
  return kHasAllMethods && lent_ != nullptr ? kLentBytes - kLentWindow : kQueueBytes;
}

int Link::window() const { return kHasAllMethods && lent_ != nullptr ? kLentWindow : kWindow; }

/// Bytes of the `index`-th packet under way; with a lent queue they stand behind it.
std::uint8_t& Link::chunk_bytes(int index) {
  return kHasAllMethods && lent_ != nullptr ? lent_[capacity() + index]
                                            : chunk_bytes_[static_cast<std::size_t>(index)];
}

void Link::clear() {
  std::uint8_t* const lent = lent_;
  const base::Direction face = face_;
  const bool was_long = is_long();
  *this = Link();
  lent_ = lent;
  face_ = face;
  is_long_ = was_long;
}

std::uint16_t Link::wrapped(int position) const {
  return static_cast<std::uint16_t>(position < capacity() ? position : position - capacity());
}

void Link::bring_up(std::uint16_t nonce, Time now) {
  const std::uint16_t last = nonce_;
  clear();
  state_ = State::kGreeting;
  nonce_ = nonce;
  while (nonce_ == 0 || nonce_ == last) {
    ++nonce_;
  }
  needs_greeting_ = true;
  heard_at_ = now;
}

void Link::bring_down() {
  const std::uint16_t last = nonce_;
  clear();
  nonce_ = last;
}

void Link::lose() {
  state_ = State::kLost;
  retry_at_ = kNever;
  needs_greeting_ = false;
}

bool Link::send(std::span<const std::uint8_t> message) {
  if (!is_used()) {
    return true;
  }
  if (queued_bytes_ + message.size() > static_cast<std::size_t>(capacity())) {
    return false;
  }
  const std::size_t tail = wrapped(head_ + queued_bytes_);
  const std::size_t room = static_cast<std::size_t>(capacity()) - tail;
  const std::size_t first = message.size() < room ? message.size() : room;
  std::memcpy(queue() + tail, message.data(), first);
  std::memcpy(queue(), message.data() + first, message.size() - first);
  queued_bytes_ = static_cast<std::uint16_t>(queued_bytes_ + message.size());
  return true;
}

void Link::drop_unsent() {
  queued_bytes_ = static_cast<std::uint16_t>(furthest_bytes_ + message_left_);
}

/// A greeting: my number, the number heard from you (0: none), am I open, what lattice I am of and
/// which face this is.
std::span<const std::uint8_t> Link::receive_greeting(std::span<const std::uint8_t> body,
                                                     const LinkTiming& timing) {
  constexpr unsigned kLatticeMask = (1U << kLatticeBits) - 1;
  if ((body[5] & kLatticeMask) != lattice_of(timing)) {
    lose();
    return {};
  }
  const auto theirs = static_cast<std::uint16_t>(body[0] | (body[1] << 8U));
  const auto heard = static_cast<std::uint16_t>(body[2] | (body[3] << 8U));
  const bool is_peer_open = body[4] != 0;
  if (is_peer_open && heard == nonce_ && peer_nonce_ == 0) {
    // To open it must have heard its own number from me, who have not heard it yet: that was before
    // I started, and I have drawn the same number again.
    bring_up(nonce_, heard_at_);
    return {};
  }
  if (peer_nonce_ != 0 && theirs != peer_nonce_) {
    if (state_ == State::kOpen) {
      is_restarted_ = true;
      return {};
    }
  }
  peer_nonce_ = theirs;
  has_mismatch_ = body[5] >> kLatticeBits != base::index(base::opposite(face_));
  if (heard == nonce_) {
    state_ = State::kOpen;
    retry_count_ = 0;
    retry_at_ = kNever;
    needs_greeting_ = !is_peer_open;
  } else {
    needs_greeting_ = true;
  }
  return {};
}

void Link::receive_acknowledgement(std::uint8_t next, const LinkTiming& timing, Time now) {
  const auto count = static_cast<std::uint8_t>((next - send_number_) & kNumberMask);
  if (count == 0 || count > known_count_) {
    return;
  }
  std::uint8_t* const chunks = &chunk_bytes(0);
  for (std::uint8_t i = 0; i < count; ++i) {
    const std::uint8_t bytes = chunks[i];
    head_ = wrapped(head_ + bytes);
    queued_bytes_ = static_cast<std::uint16_t>(queued_bytes_ - bytes);
    furthest_bytes_ = static_cast<std::uint16_t>(furthest_bytes_ - bytes);
    // An acknowledgement can overtake a packet that is being sent again.
    sent_bytes_ = static_cast<std::uint16_t>(sent_bytes_ > bytes ? sent_bytes_ - bytes : 0);
  }
  for (int i = count; i < window(); ++i) {
    chunks[i - count] = chunks[i];
  }
  known_count_ = static_cast<std::uint8_t>(known_count_ - count);
  sent_count_ = static_cast<std::uint8_t>(sent_count_ > count ? sent_count_ - count : 0);
  send_number_ = static_cast<std::uint8_t>((send_number_ + count) & kNumberMask);
  retry_count_ = 0;
  retry_at_ = sent_count_ > 0 ? now + timing.retransmit_after : kNever;
}

std::span<const std::uint8_t> Link::receive(std::span<const std::uint8_t> packet,
                                            const LinkTiming& timing, Time now) {
  constexpr int kOverhead = wire::kHeaderBytes + wire::kChecksumBytes;
  if (!(is_used() || is_calling()) || packet.size() < static_cast<std::size_t>(kOverhead)) {
    return {};
  }
  const auto [kind, sequence, version, expected] = wire::header_of(packet);
  const auto body =
      packet.subspan(wire::kHeaderBytes, packet.size() - static_cast<std::size_t>(kOverhead));
  const auto end = packet.size() - wire::kChecksumBytes;
  const auto sum = static_cast<std::uint16_t>(packet[end] | (packet[end + 1] << 8U));
  const bool is_greeting = kind == PacketKind::kHello;
  const std::uint16_t start = is_greeting ? kGreetingChecksum : session(peer_nonce_, nonce_);
  if (version != wire::kVersion || wire::checksum(packet.first(end), start) != sum) {
    return {};
  }
  if (is_calling()) {
    is_restarted_ = is_greeting && body.size() == kGreetingBytes;
    return {};
  }
  if (is_greeting) {
    heard_at_ = now;
    return body.size() == kGreetingBytes ? receive_greeting(body, timing) : body.first(0);
  }
  if (peer_nonce_ == 0) {
    return {};
  }
  heard_at_ = now;
  // Only a neighbour that has heard my number can make this checksum.
  if (state_ == State::kGreeting) {
    state_ = State::kOpen;
    needs_greeting_ = false;
    retry_count_ = 0;
    retry_at_ = kNever;
  }
  receive_acknowledgement(expected, timing, now);
  if (known_count_ == 0) {
    retry_count_ = 0;
    retry_at_ = kNever;
  }
  if (kind == PacketKind::kAcknowledge) {
    return {};
  }
  const bool is_new = kind == PacketKind::kData && sequence == receive_number_;
  if (!owes_acknowledgement_) {
    owes_acknowledgement_ = true;
    acknowledge_at_ = is_new ? now + timing.acknowledge_after : now;
  }
  if constexpr (kHasAllMethods) {
    const bool is_full = static_cast<int>(packet.size()) == timing.packet_bytes;
    if (lent_ != nullptr && is_new && is_full && sequence % 2 != 0) {
      acknowledge_at_ = now;
    }
  }
  if (!is_new) {
    return {};
  }
  receive_number_ = static_cast<std::uint8_t>((receive_number_ + 1) & kNumberMask);
  return body;
}

std::span<const std::uint8_t> Link::next_message(std::span<const std::uint8_t>& stream) {
  while (!stream.empty()) {
    // Two bytes tell the size; then the rest comes in one piece.
    std::size_t wanted = 1;
    if (message_bytes_ >= 2) {
      wanted = static_cast<std::size_t>(message_size_ - message_bytes_);
      wanted = wanted < stream.size() ? wanted : stream.size();
    }
    HOLDFAST_ASSERT(message_bytes_ + wanted <= message_.size());
    std::memcpy(message_.data() + message_bytes_, stream.data(), wanted);
    stream = stream.subspan(wanted);
    message_bytes_ = static_cast<std::uint8_t>(message_bytes_ + wanted);
    if (message_bytes_ == 2) {
      message_size_ = static_cast<std::uint8_t>(wire::message_bytes(message_[0], message_[1]));
      if (message_size_ < 2) {
        lose();
        stream = {};
        return {};
      }
    }
    if (message_bytes_ >= 2 && message_bytes_ == message_size_) {
      message_bytes_ = 0;
      return {message_.data(), message_size_};
    }
  }
  return {};
}

bool Link::take_restarted() {
  const bool is_restarted = is_restarted_;
  is_restarted_ = false;
  return is_restarted;
}

bool Link::has_packet(Time now) const {
  if (!is_used()) {
    return is_calling() && needs_greeting_;
  }
  const bool has_data = state_ == State::kOpen &&
                        sent_count_ < (kHasAllMethods ? window() : kWindow) &&
                        sent_bytes_ < queued_bytes_;
  return needs_greeting_ || needs_ping_ || has_data ||
         (owes_acknowledgement_ && now >= acknowledge_at_);
}

int Link::write_greeting(std::span<std::uint8_t> packet, const LinkTiming& timing, Time now) {
  needs_greeting_ = false;
  packet[0] = header(static_cast<std::uint8_t>(PacketKind::kHello), 0);
  packet[1] = header(wire::kVersion, 0);
  packet[2] = static_cast<std::uint8_t>(nonce_ & 0xffU);
  packet[3] = static_cast<std::uint8_t>(nonce_ >> 8U);
  packet[4] = static_cast<std::uint8_t>(peer_nonce_ & 0xffU);
  packet[5] = static_cast<std::uint8_t>(peer_nonce_ >> 8U);
  packet[6] = state_ == State::kOpen ? 1 : 0;
  packet[7] = static_cast<std::uint8_t>(lattice_of(timing) |
                                        static_cast<unsigned>(base::index(face_)) << kLatticeBits);
  if (state_ == State::kGreeting) {
    retry_at_ = now + patience(timing);
  }
  return finish(packet, wire::kHeaderBytes + kGreetingBytes, kGreetingChecksum);
}

/// Bytes of the next data packet: as before if it is sent again, else as many as fit.
int Link::packet_chunk(const LinkTiming& timing) {
  if (sent_count_ < known_count_) {
    return chunk_bytes(sent_count_);
  }
  const int room = timing.packet_bytes - wire::kHeaderBytes - wire::kChecksumBytes;
  const int waiting = queued_bytes_ - sent_bytes_;
  return waiting < room ? waiting : room;
}

int Link::write_packet(std::span<std::uint8_t> packet, const LinkTiming& timing, Time now) {
  if (!has_packet(now)) {
    return 0;
  }
  if (needs_greeting_) {
    return write_greeting(packet, timing, now);
  }
  auto kind = PacketKind::kAcknowledge;
  int size = wire::kHeaderBytes;
  std::uint8_t number = 0;
  if (sent_count_ < (kHasAllMethods ? window() : kWindow) && sent_bytes_ < queued_bytes_) {
    kind = PacketKind::kData;
    const int chunk = packet_chunk(timing);
    const int cursor = wrapped(head_ + sent_bytes_);
    const int room = capacity() - cursor;
    const auto first = static_cast<std::size_t>(chunk < room ? chunk : room);
    std::memcpy(packet.data() + size, queue() + cursor, first);
    std::memcpy(packet.data() + size + first, queue(), static_cast<std::size_t>(chunk) - first);
    size += chunk;
    number = static_cast<std::uint8_t>((send_number_ + sent_count_) & kNumberMask);
    chunk_bytes(sent_count_++) = static_cast<std::uint8_t>(chunk);
    sent_bytes_ = static_cast<std::uint16_t>(sent_bytes_ + chunk);
    known_count_ = known_count_ > sent_count_ ? known_count_ : sent_count_;
    // Follow message boundaries, so that drop_unsent() never cuts a message.
    while (furthest_bytes_ < sent_bytes_) {
      if (message_left_ == 0) {
        const auto at = static_cast<int>(head_) + furthest_bytes_;
        message_left_ = static_cast<std::uint16_t>(
            wire::message_bytes(queue()[wrapped(at)], queue()[wrapped(wrapped(at) + 1)]));
      }
      const int rest = sent_bytes_ - furthest_bytes_;
      const int passed = rest < message_left_ ? rest : message_left_;
      furthest_bytes_ = static_cast<std::uint16_t>(furthest_bytes_ + passed);
      message_left_ = static_cast<std::uint16_t>(message_left_ - passed);
    }
    if (retry_at_ == kNever) {
      retry_at_ = now + patience(timing);
    }
  } else if (needs_ping_) {
    kind = PacketKind::kPing;
    retry_at_ = retry_at_ == kNever ? now + patience(timing) : retry_at_;
  }
  needs_ping_ = false;
  owes_acknowledgement_ = false;
  acknowledge_at_ = kNever;
  packet[0] = header(static_cast<std::uint8_t>(kind), number);
  packet[1] = header(wire::kVersion, receive_number_);
  return finish(packet, size, session(nonce_, peer_nonce_));
}

Time Link::patience(const LinkTiming& timing) const { return patience_of(timing, retry_count_); }

void Link::on_time(const LinkTiming& timing, bool is_watched, Time now) {
  if (is_calling() && now >= retry_at_) {
    needs_greeting_ = true;
    retry_at_ = now + timing.ping_after;
  }
  if (!is_used()) {
    return;
  }
  if (now >= retry_at_) {
    if (++retry_count_ > timing.lost_after_retries) {
      state_ = State::kLost;
      retry_at_ = now + timing.ping_after;
      needs_greeting_ = false;
      return;
    }
    retry_at_ = kNever;
    if (state_ == State::kGreeting) {
      needs_greeting_ = true;
    } else if (known_count_ > 0) {
      sent_count_ = 0;
      sent_bytes_ = 0;
    } else {
      needs_ping_ = true;
    }
  }
  if (is_watched && state_ == State::kOpen && retry_at_ == kNever && !needs_ping_ &&
      now >= heard_at_ + timing.ping_after) {
    needs_ping_ = true;
  }
}

Time Link::deadline(const LinkTiming& timing, bool is_watched) const {
  if (!is_used()) {
    return is_calling() ? retry_at_ : kNever;
  }
  Time at = retry_at_;
  if (owes_acknowledgement_ && acknowledge_at_ < at) {
    at = acknowledge_at_;
  }
  if (is_watched && state_ == State::kOpen && retry_at_ == kNever && !needs_ping_ &&
      heard_at_ + timing.ping_after < at) {
    at = heard_at_ + timing.ping_after;
  }
  return at;
}

}  // namespace holdfast::agent
