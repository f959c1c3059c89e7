// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/messages/messages.hpp"

#include "holdfast/agent/algebra/branch.hpp"
#include "holdfast/agent/cells/occupied_cells.hpp"
#include "holdfast/agent/cells/planned_set.hpp"
#include "holdfast/agent/cells/step_word.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "messages/codec.hpp"

namespace holdfast::agent {
namespace {

using wire::Codec;
using wire::MessageType;
using wire::Ruler;
using wire::Writer;

constexpr std::uint8_t kWaves = 3;

/// Where the fields begin: behind the type.
constexpr int kFieldsAt = 1;

constexpr void round_fields(auto& codec, Round& round) {
  codec.u16(round.epoch, 1, 0xffff);
  codec.u32(round.starter);
}

constexpr void fields(auto& codec, Join& join) {
  round_fields(codec, join.round);
  auto number = static_cast<std::uint8_t>(join.wave + kWaves * join.stage);
  codec.u8(number, 1, kKeepsAnswers ? kWaves * (1 + kStageCount) : kWaves);
  join.wave = static_cast<std::uint8_t>((number + kWaves - 1) % kWaves + 1);
  join.stage = static_cast<std::uint8_t>((number + kWaves - 1) / kWaves - 1);
  codec.cell(join.cell);
  codec.u16(join.hops);
}

constexpr void fields(auto& codec, Echo& echo) {
  round_fields(codec, echo.round);
  codec.u8(echo.wave, 1, kWaves);
  codec.u32(echo.count);
  codec.u16(echo.hops);
  codec.u32(echo.id);
  codec.kind(echo.doubt, Doubt::kNone, Doubt::kFacesMismatch);
}

constexpr void fields(auto& codec, Appointment& appointment) {
  codec.u8(appointment.wave, 1, kWaves - 1);
  codec.u32(appointment.id);
  codec.u16(appointment.hops);
}

constexpr void fields(auto& codec, Mark& mark) {
  codec.u16(mark.hops);
  codec.cell(mark.sender);
}

constexpr void fields(auto& codec, Cut& cut) {
  codec.cell(cut.cell);
  codec.direction(cut.direction);
  codec.require(base::index(cut.direction) % 2 == 0);
}

constexpr void fields(auto& codec, Adoption& adoption) {
  round_fields(codec, adoption.round);
  codec.cell(adoption.sender);
  codec.cell(adoption.root);
  codec.u16(adoption.hops);
  codec.u32(adoption.wave_time);
  codec.real(adoption.load_ratio);
}

constexpr void fields(auto& codec, News& news) {
  codec.flags(news.flags, kIsFulfilled | kIsEnded | kIsGrown);
  codec.u16(news.hops);
  codec.place(news.cell);
}

/// The largest label.
constexpr std::uint8_t label_last(MessageType type) {
  switch (type) {
    case MessageType::kColumn:
      return Branch::kColumnCount + Branch::kPartCount - 1;
    case MessageType::kBranchUp:
    case MessageType::kBranchDown:
      return kLoopsMax;
    case MessageType::kPlannedUp:
      return kPlannedMost - 1;
    case MessageType::kReach:
      return kReachLabelLast;
    default:
      return 0xff;
  }
}

constexpr void fields(auto& codec, LabelledVector& labelled) {
  codec.u8(labelled.label, 0, label_last(labelled.type));
  codec.require(labelled.type != MessageType::kPlannedDown ||
                (labelled.label & kPlannedIndexMask) < kPlannedMost);
  for (float& value : labelled.vector) {
    codec.real(value);
  }
}

template <class Message>
Writer written(MessageType type, Message message) {
  Writer out(type);
  Codec codec(out);
  fields(codec, message);
  return out;
}

template <class Message>
bool read(std::span<const std::uint8_t> bytes, Message& message) {
  Codec codec(bytes, kFieldsAt);
  fields(codec, message);
  return codec.is_legal();
}

/// Is it a legal order, or report?
template <class Message>
bool is_read(std::span<const std::uint8_t> bytes, int face_count) {
  Message message;
  return decode(bytes, message, face_count);
}

template <class Message>
constexpr int bytes_of(Message message) {
  Ruler ruler(kFieldsAt);
  fields(ruler, message);
  return ruler.bytes();
}

static_assert(bytes_of(LabelledVector{}) == wire::kVectorBytes);
static_assert(kFieldsAt + 1 + OccupiedCells::kPartBytes == wire::kVectorBytes);

}  // namespace

bool is_legal(std::span<const std::uint8_t> message, int face_count) {
  Codec codec(message, kFieldsAt);
  codec.set_face_count(face_count);
  const auto is_legal_as = [&codec](auto value) {
    fields(codec, value);
    return codec.is_legal();
  };
  const auto type = static_cast<MessageType>(message[0]);
  switch (type) {
    case MessageType::kVector:
      return true;  // Most messages are.
    case MessageType::kOrder:
      return is_read<Order>(message, face_count);
    case MessageType::kReport:
      return is_read<Report>(message, face_count);
    case MessageType::kJoin:
      return is_legal_as(Join{});
    case MessageType::kEcho:
      return is_legal_as(Echo{});
    case MessageType::kAppoint:
      return is_legal_as(Appointment{});
    case MessageType::kMark:
      return is_legal_as(Mark{});
    case MessageType::kLoop:
      return is_legal_as(Cut{});
    case MessageType::kPlannedDown:
    case MessageType::kPlannedUp:
    case MessageType::kColumn:
    case MessageType::kBranchUp:
    case MessageType::kBranchDown:
      return is_legal_as(LabelledVector{.type = type});
    case MessageType::kFrontUp:
    case MessageType::kFrontDown:
      return kHasAllMethods;
    case MessageType::kAdopt:
      return kKeepsAnswers && is_legal_as(Adoption{});
    case MessageType::kNews:
      return kKeepsAnswers && is_legal_as(News{});
    case MessageType::kCellsUp:
    case MessageType::kCellsDown:
      return kKeepsAnswers && message[1] < OccupiedCells::kPartsMax;
    case MessageType::kReach:
      return kKeepsAnswers && is_legal_as(LabelledVector{.type = type});
  }
  return false;
}

Writer encode(const Join& join) { return written(MessageType::kJoin, join); }

Writer encode(const Echo& echo) { return written(MessageType::kEcho, echo); }

Writer encode(const Appointment& appointment) {
  return written(MessageType::kAppoint, appointment);
}

Writer encode(const Mark& mark) { return written(MessageType::kMark, mark); }

Writer encode(const Cut& cut) { return written(MessageType::kLoop, cut); }

Writer encode(const Adoption& adoption) { return written(MessageType::kAdopt, adoption); }

Writer encode(const News& news) { return written(MessageType::kNews, news); }

Writer encode(const LabelledVector& labelled) { return written(labelled.type, labelled); }

Writer part_message(MessageType type, std::uint8_t index, std::span<const std::uint8_t> bits) {
  Writer out(type);
  out.u8(index);
  for (const std::uint8_t byte : bits) {
    out.u8(byte);
  }
  return out;
}

bool decode(std::span<const std::uint8_t> message, Join& join) { return read(message, join); }

bool decode(std::span<const std::uint8_t> message, Echo& echo) { return read(message, echo); }

bool decode(std::span<const std::uint8_t> message, Appointment& appointment) {
  return read(message, appointment);
}

bool decode(std::span<const std::uint8_t> message, Mark& mark) { return read(message, mark); }

bool decode(std::span<const std::uint8_t> message, Cut& cut) { return read(message, cut); }

bool decode(std::span<const std::uint8_t> message, Adoption& adoption) {
  return read(message, adoption);
}

bool decode(std::span<const std::uint8_t> message, News& news) { return read(message, news); }

bool decode(std::span<const std::uint8_t> message, LabelledVector& labelled) {
  labelled.type = static_cast<MessageType>(message[0]);
  return read(message, labelled);
}

}  // namespace holdfast::agent
