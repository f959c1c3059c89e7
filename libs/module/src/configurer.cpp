// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/configurer.hpp"

namespace holdfast::module {
namespace {

/// How many bytes of a setup go into one frame: two parts, or more on lines with short ones.
constexpr std::size_t kPartBytes =
    kPayloadBytesMax - kPartHeaderBytes < 124 ? kPayloadBytesMax - kPartHeaderBytes : 124;
constexpr int kPartCount = static_cast<int>((kSetupBytes + kPartBytes - 1) / kPartBytes);
static_assert(kPartCount <= 32);

/// The bytes of a setup that a part has.
std::pair<std::size_t, std::size_t> place_of(int part) {
  const std::size_t begin = static_cast<std::size_t>(part) * kPartBytes;
  return {begin, begin + kPartBytes < kSetupBytes ? kPartBytes : kSetupBytes - begin};
}

/// A configuration by message has passed two sums, and may still be of a faulty sender: numbers
/// that the program relies on must be such.
bool is_sensible(const agent::CubeSetup& setup) {
  const auto is_positive = [](double value) { return value > 0 && value < 1e30; };
  return setup.timing.packet_bytes >= agent::wire::kPacketBytesMin &&
         setup.timing.packet_bytes <= kPayloadBytesMax && setup.facet_numerator > 0 &&
         setup.facet_denominator > 0 && is_positive(setup.facet_mm) &&
         is_positive(setup.weight_n) && is_positive(setup.strength_vertical_n) &&
         is_positive(setup.strength_lateral_n) && is_positive(setup.contact_gamma) &&
         is_positive(setup.section.elastic_modulus) && is_positive(setup.section.length) &&
         setup.method <= agent::Method::kFronts;
}

}  // namespace

std::size_t write_part(std::span<const std::uint8_t> setup, std::uint16_t revision,
                       std::uint8_t index, std::span<std::uint8_t, kPayloadBytesMax> payload) {
  if (index >= kPartCount) {
    return 0;
  }
  PayloadWriter out(payload);
  const ConfigurationPart part{.revision = revision, .sum = sum_of_setup(setup), .index = index};
  each_field(part, out);
  const auto [begin, size] = place_of(index);
  out.bytes(setup.subspan(begin, size));
  return out.written().size();
}

Configurer::Configurer(Port& port, Configuration& configuration)
    : RelayedPort(port), configuration_(configuration), is_configured_(is_valid(configuration)) {}

bool Configurer::take_change() {
  if (!has_changed_) {
    return false;
  }
  if (is_complete_) {
    adopt();
  }
  seal();
  has_changed_ = false;
  return is_configured_;
}

Revision Configurer::own() const {
  return {.flags = is_configured_ ? Revision::kIsThere : std::uint8_t{0},
          .number = is_configured_ ? configuration_.revision : std::uint16_t{0},
          .sum = is_configured_ ? setup_sum(configuration_) : std::uint16_t{0}};
}

bool Configurer::is_older_than(const Revision& other) const {
  if (!is_configured_ || (other.flags & Revision::kIsThere) == 0) {
    return (other.flags & Revision::kIsThere) != 0;
  }
  const Revision mine = own();
  const auto ahead = static_cast<std::int16_t>(other.number - mine.number);
  return ahead > 0 || (ahead == 0 && other.sum > mine.sum);
}

bool Configurer::receive(Incoming& incoming) {
  while (RelayedPort::receive(incoming)) {
    Face& face = faces_[static_cast<std::size_t>(incoming.face)];
    Who who;
    switch (incoming.kind) {
      case FrameKind::kRevision:
        take_revision(face, incoming.payload);
        break;
      case FrameKind::kConfigure:
        take_part(face, incoming.payload);
        break;
      case FrameKind::kWho:
        if (read_fields(incoming.payload, who)) {
          tell_who(who);
        }
        break;
      case FrameKind::kPacket:
        if (!speaks() || face.is_agreed) {
          return true;
        }
        break;
      default:
        return true;
    }
    if (has_changed_) {
      return false;  // The program that asks for more is out of date.
    }
  }
  return false;
}

void Configurer::send(int face, std::span<const std::uint8_t> packet) {
  if (!speaks() || faces_[static_cast<std::size_t>(face)].is_agreed) {
    RelayedPort::send(face, packet);
  }
}

void Configurer::take_revision(Face& face, std::span<const std::uint8_t> payload) {
  Revision theirs;
  if (!read_fields(payload, theirs)) {
    return;
  }
  const Revision mine = own();
  face.is_agreed = is_configured_ && (theirs.flags & Revision::kIsThere) != 0 &&
                   theirs.number == mine.number && theirs.sum == mine.sum;
  const bool is_theirs_older = is_configured_ && !face.is_agreed && !is_older_than(theirs);
  if (is_theirs_older && face.next_part < 0) {
    face.next_part = 0;
  }
  face.says = face.says || (theirs.flags & Revision::kAsks) != 0 || is_older_than(theirs);
}

void Configurer::take_part(Face& face, std::span<const std::uint8_t> payload) {
  PayloadReader in(payload);
  ConfigurationPart part;
  each_field(part, in);
  const Revision theirs{.flags = Revision::kIsThere, .number = part.revision, .sum = part.sum};
  if (!in.is_whole() || part.index >= kPartCount) {
    return;
  }
  const auto [begin, size] = place_of(part.index);
  if (in.rest().size() != size) {
    return;
  }
  if (!is_older_than(theirs)) {
    face.says = true;
    return;
  }
  if (arriving_.number != theirs.number || arriving_.sum != theirs.sum) {
    arriving_ = theirs;
    arrived_ = 0;
  }
  auto* const to = reinterpret_cast<std::uint8_t*>(&setup_);
  for (std::size_t i = 0; i < size; ++i) {
    to[begin + i] = in.rest()[i];
  }
  arrived_ |= 1U << part.index;
  if (arrived_ == (1ULL << kPartCount) - 1) {
    take_whole();
  }
}

/// All parts are there. The program still uses the old setup.
void Configurer::take_whole() {
  arrived_ = 0;
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(&setup_),
                                            kSetupBytes);
  is_complete_ = sum_of_setup(bytes) == arriving_.sum && is_sensible(setup_);
  has_changed_ = has_changed_ || is_complete_;
}

void Configurer::adopt() {
  is_complete_ = false;
  const auto* const from = reinterpret_cast<const std::uint8_t*>(&setup_);
  auto* const to = reinterpret_cast<std::uint8_t*>(&configuration_.setup);
  for (std::size_t i = 0; i < kSetupBytes; ++i) {
    to[i] = from[i];
  }
  configuration_.revision = arriving_.number;
  is_configured_ = true;
  faces_ = {};
}

void Configurer::tell_who(const Who& who) {
  agent::Identity& own = configuration_.identity;
  const agent::Identity before = own;
  switch (who.what) {
    case Who::What::kAnchor:
      own.is_anchor = true;
      own.cell = who.cell;
      break;
    case Who::What::kNoAnchor:
      own.is_anchor = false;
      break;
    case Who::What::kFixed:
      own.is_fixed = true;
      break;
    case Who::What::kFree:
      own.is_fixed = false;
      break;
    default:
      return;
  }
  has_changed_ = has_changed_ || before.is_fixed != own.is_fixed ||
                 before.is_anchor != own.is_anchor || !(before.cell == own.cell);
}

void Configurer::seal() {
  configuration_.magic = is_configured_ ? kConfigurationMagic : kIdentityMagic;
  configuration_.checksum = checksum_of(configuration_);
  keep({reinterpret_cast<const std::uint8_t*>(&configuration_), kConfigurationBytes});
}

/// Says what is due at a face, one frame; true: there is more.
bool Configurer::serve(int at) {
  Face& face = faces_[static_cast<std::size_t>(at)];
  const bool is_there = is_connected(at);
  face.is_agreed = face.is_agreed && is_there;
  const bool asks = is_there && speaks() && !face.is_agreed && face.asks_at <= now();
  if (!face.says && !asks && face.next_part < 0) {
    return false;
  }
  if (!is_line_free(at)) {
    return true;
  }
  if (face.says || asks) {
    Revision mine = own();
    mine.flags = static_cast<std::uint8_t>(mine.flags | (asks ? Revision::kAsks : 0U));
    std::array<std::uint8_t, sizeof(Revision)> bytes;
    PayloadWriter out(bytes);
    each_field(mine, out);
    tell(at, FrameKind::kRevision, out.written());
    face.says = false;
    face.asks_at = asks ? now() + kSayEvery : face.asks_at;
  } else {
    send_part(at);
  }
  return face.next_part >= 0;
}

void Configurer::send_part(int at) {
  Face& face = faces_[static_cast<std::size_t>(at)];
  std::array<std::uint8_t, kPayloadBytesMax> bytes;
  const std::size_t size = write_part(setup_bytes(configuration_), configuration_.revision,
                                      static_cast<std::uint8_t>(face.next_part), bytes);
  tell(at, FrameKind::kConfigure, std::span<const std::uint8_t>(bytes).first(size));
  face.next_part = face.next_part + 1 < kPartCount ? face.next_part + 1 : -1;
  face.asks_at = face.next_part < 0 ? now() : face.asks_at;
}

void Configurer::wait(Time until) {
  for (int at = 0; at < base::kDirectionCount; ++at) {
    const bool has_more = serve(at);
    const Face& face = faces_[static_cast<std::size_t>(at)];
    if (!is_line_free(at)) {
      continue;
    }
    until = has_more ? Time{0} : until;
    if (speaks() && !face.is_agreed && is_connected(at)) {
      until = face.asks_at < until ? face.asks_at : until;
    }
  }
  RelayedPort::wait(has_changed_ ? Time{0} : until);
}

}  // namespace holdfast::module
