// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/instrument.hpp"

namespace holdfast::module {

Instrument::Instrument(Port& port, const Configuration& configuration)
    : RelayedPort(port), configuration_(configuration) {
  log(LogEntry::What::kStarted, health().reset_reason);
}

void Instrument::speak_of(const Module* module) {
  module_ = module;
  last_ = {};
  if (module_ != nullptr && configuration_.revision != 0) {
    log(LogEntry::What::kConfigured, 0, configuration_.revision);
  }
}

bool Instrument::receive(Incoming& incoming) {
  while (RelayedPort::receive(incoming)) {
    if (incoming.kind == FrameKind::kPlan) {
      log_plan(incoming.payload);
    } else if (incoming.kind == FrameKind::kPacket) {
      log_other_version(incoming);
    }
    if (incoming.kind != FrameKind::kAsk) {
      return true;
    }
    Ask ask;
    if (read_fields(incoming.payload, ask)) {
      asked_[static_cast<std::size_t>(incoming.face)] |= ask.what;
      log_from_ = (ask.what & Ask::kLog) != 0 ? ask.log_from : log_from_;
    }
  }
  return false;
}

void Instrument::wait(Time until) {
  note();
  for (int face = 0; face < base::kDirectionCount; ++face) {
    const std::uint8_t& asked = asked_[static_cast<std::size_t>(face)];
    if (asked != 0 && is_line_free(face)) {
      answer(face);
      until = asked != 0 && is_line_free(face) ? Time{0} : until;
    }
  }
  RelayedPort::wait(until);
}

/// One frame for each line that is free: the status, then the log.
void Instrument::answer(int face) {
  std::uint8_t& asked = asked_[static_cast<std::size_t>(face)];
  if ((asked & Ask::kStatus) != 0) {
    std::array<std::uint8_t, sizeof(StatusReport)> bytes;
    PayloadWriter out(bytes);
    const StatusReport now = report();
    each_field(now, out);
    tell(face, FrameKind::kStatus, out.written());
    asked = static_cast<std::uint8_t>(asked & Ask::kLog);
    return;
  }
  if ((asked & Ask::kLog) != 0) {
    tell_log(face);
  }
  asked = 0;
}

/// The entries from the one that was asked for, as far as they are still there and fit.
void Instrument::tell_log(int face) {
  std::array<std::uint8_t, kPayloadBytesMax> bytes;
  PayloadWriter out(bytes);
  auto count = static_cast<std::uint16_t>(log_next_ - log_from_);
  // More than there ever were: whoever asks has known the module before its reset.
  const std::uint16_t kept = log_next_ < kLogCount ? log_next_ : kLogCount;
  count = count > kept ? kept : count;
  auto number = static_cast<std::uint16_t>(log_next_ - count);
  out.u16(number);
  for (int i = 0; i < kLogEntriesMax && number != log_next_; ++i, ++number) {
    each_field(log_[number % kLogCount], out);
  }
  tell(face, FrameKind::kLog, out.written());
}

StatusReport Instrument::report() {
  const Health board = health();
  const agent::Identity& own = configuration_.identity;
  StatusReport out;
  const auto set = [&out](bool is_so, std::uint8_t flag) {
    out.flags = static_cast<std::uint8_t>(out.flags | (is_so ? flag : 0U));
  };
  set(own.is_fixed, StatusReport::kIsFixed);
  set(own.is_anchor, StatusReport::kIsAnchor);
  out.connected = connected_;
  out.reset_reason = board.reset_reason;
  out.stack_bytes = board.stack_bytes;
  out.log_next = log_next_;
  out.id = own.id;
  out.time_us = static_cast<std::uint32_t>(now());
  if (module_ == nullptr) {
    return out;
  }
  const Status& status = module_->status();
  const agent::Agent& agent = module_->agent();
  set(true, StatusReport::kHasConfiguration);
  set(agent.has_cell(), StatusReport::kHasCell);
  set(agent.is_root(), StatusReport::kIsRoot);
  out.verdict = static_cast<std::uint8_t>(status.verdict);
  out.reason = static_cast<std::uint8_t>(status.reason);
  out.phase = status.phase;
  out.epoch = static_cast<std::uint16_t>(status.epoch);
  out.refused_count = agent.refused_count();
  out.revision = configuration_.revision;
  out.setup_sum = setup_sum(configuration_);
  out.plan_count = status.plan_count;
  out.cell = agent.has_cell() ? agent.cell() : base::Cell{};
  out.worst_cell = status.worst_cell;
  out.worst_direction = static_cast<std::uint8_t>(status.worst_direction);
  out.load_ratio_max = status.load_ratio_max;
  out.own_load_ratio = status.own_load_ratio;
  return out;
}

void Instrument::log(LogEntry::What what, std::uint8_t value, std::uint16_t number,
                     const base::Cell& cell) {
  log_[log_next_ % kLogCount] = {.time_us = static_cast<std::uint32_t>(now()),
                                 .what = what,
                                 .value = value,
                                 .number = number,
                                 .cell = cell};
  ++log_next_;
}

/// Once for each neighbour: its program has to be replaced, or this one.
void Instrument::log_other_version(const Incoming& packet) {
  const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(packet.face));
  const bool is_whole =
      packet.payload.size() >= agent::wire::kHeaderBytes + agent::wire::kChecksumBytes;
  const unsigned version = is_whole ? packet.payload[1] >> 6U : agent::wire::kVersion;
  if (version != agent::wire::kVersion && (others_ & bit) == 0) {
    log(LogEntry::What::kOtherVersion, static_cast<std::uint8_t>(packet.face),
        static_cast<std::uint16_t>(version));
    others_ = static_cast<std::uint8_t>(others_ | bit);
  }
}

void Instrument::log_plan(std::span<const std::uint8_t> payload) {
  PayloadReader in(payload);
  base::Cell cell;
  in.cell(cell);
  if (in.is_whole()) {
    log(in.rest().empty() ? LogEntry::What::kPlan : LogEntry::What::kWithdraw, 0, 0, cell);
  }
}

void Instrument::note() {
  note_neighbours();
  if (module_ == nullptr) {
    return;
  }
  const Status& status = module_->status();
  if (status.epoch != last_.epoch) {
    log(LogEntry::What::kJoined, 0, static_cast<std::uint16_t>(status.epoch));
  }
  if (status.phase != last_.phase) {
    log(LogEntry::What::kPhase, status.phase);
  }
  if (status.verdict != last_.verdict || status.reason != last_.reason) {
    log(LogEntry::What::kVerdict, static_cast<std::uint8_t>(status.verdict),
        static_cast<std::uint16_t>(status.reason));
  }
  last_ = status;
}

void Instrument::note_neighbours() {
  std::uint8_t connected = 0;
  for (int face = 0; face < base::kDirectionCount; ++face) {
    const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(face));
    const bool is_there = is_connected(face);
    connected = static_cast<std::uint8_t>(connected | (is_there ? bit : 0U));
    if (is_there != ((connected_ & bit) != 0)) {
      others_ = static_cast<std::uint8_t>(is_there ? others_ : others_ & ~bit);
      log(is_there ? LogEntry::What::kHeard : LogEntry::What::kUnheard,
          static_cast<std::uint8_t>(face));
    }
  }
  connected_ = connected;
}

}  // namespace holdfast::module
