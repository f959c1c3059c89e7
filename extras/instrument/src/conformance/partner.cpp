// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "partner.hpp"

#include <algorithm>

namespace holdfast::instrument {
namespace {

constexpr int kGoneMs = 400;  // After 250 ms a neighbour counts as gone.
constexpr int kAnswerMs = 1'000;

int kind_of(const by_hand::Bytes& packet) { return packet.empty() ? -1 : packet[0] >> 6; }

int number_at(const by_hand::Bytes& packet, std::size_t offset) {
  return packet[offset] | packet[offset + 1] << 8;
}

}  // namespace

void Partner::pump(int time_ms) {
  constexpr auto kHelloEvery = std::chrono::milliseconds(80);
  constexpr std::uint8_t kHello = 0x05;
  if (says_hello_ && Clock::now() >= hello_at_) {
    device_.write({&kHello, 1});
    hello_at_ = Clock::now() + kHelloEvery;
  }
  std::array<std::uint8_t, 512> bytes{};
  const std::size_t size = device_.read(bytes, time_ms);
  for (const std::uint8_t byte : std::span(bytes).first(size)) {
    if (reader_.take(byte)) {
      frames_.push_back(reader_.frame());
    }
  }
}

void Partner::wait(int time_ms) {
  const auto end = Clock::now() + std::chrono::milliseconds(time_ms);
  while (Clock::now() < end) {
    pump(5);
  }
}

void Partner::leave() {
  says_hello_ = false;
  wait(kGoneMs);
  frames_.clear();
  stream_.clear();
  reader_ = {};
  said_.clear();
  expected_ = 0;
  sequence = 0;
  acknowledges = true;
  face = 1;
  mine = mine + 0x0101 < 0x7000 ? mine + 0x0101 : 0x1234;
}

bool Partner::meet() {
  says_hello_ = true;
  const auto heard = packet(3, 3 * kAnswerMs);
  theirs = heard && heard->size() >= 4 ? number_at(*heard, 2) : 0;
  return heard.has_value();
}

bool Partner::open() {
  if (!meet()) {
    return false;
  }
  const auto end = Clock::now() + std::chrono::milliseconds(3 * kAnswerMs);
  auto again = Clock::now();
  while (Clock::now() < end) {
    if (Clock::now() >= again) {  // A busy module, or a bad line, may need it again.
      say_packet(by_hand::packet(greeting(false)));
      again = Clock::now() + std::chrono::milliseconds(200);
    }
    const auto answer = packet(3, 20);
    // It draws another number if it has missed me for a moment.
    theirs = answer && answer->size() == 10 ? number_at(*answer, 2) : theirs;
    if (answer && answer->size() == 10 && number_at(*answer, 4) == mine && (*answer)[6] == 1) {
      say_packet(by_hand::packet(greeting(true)));
      return true;
    }
  }
  return false;
}

bool Partner::join() {
  constexpr std::size_t kJoinBytes = 19;
  if (!open()) {
    return false;
  }
  const Bytes wave = take(kJoinBytes);
  epoch = wave.size() == kJoinBytes ? number_at(wave, 1) : 0;
  return wave.size() == kJoinBytes && wave[0] == 1;
}

void Partner::say(const Bytes& raw) {
  said_ = raw;
  device_.write(raw);
}

void Partner::tell(const Bytes& messages) { say_packet(data(sequence++, messages)); }

std::optional<by_hand::Bytes> Partner::any_packet(int time_ms) { return frame(1, time_ms); }

std::optional<by_hand::Bytes> Partner::frame(std::uint8_t kind, int time_ms) {
  const auto end = Clock::now() + std::chrono::milliseconds(time_ms);
  do {
    for (; !frames_.empty(); frames_.pop_front()) {
      if (frames_.front().kind == kind) {
        Bytes payload = std::move(frames_.front().payload);
        frames_.pop_front();
        return payload;
      }
    }
    pump(2);
  } while (Clock::now() < end);
  return std::nullopt;
}

std::optional<by_hand::Bytes> Partner::packet(int kind, int time_ms) {
  const auto end = Clock::now() + std::chrono::milliseconds(time_ms);
  do {
    auto any = any_packet(5);
    if (any && kind_of(*any) == kind) {
      return any;
    }
  } while (Clock::now() < end);
  return std::nullopt;
}

std::optional<by_hand::Bytes> Partner::answered_greeting(int time_ms) {
  const auto end = Clock::now() + std::chrono::milliseconds(time_ms);
  std::optional<Bytes> last;
  while (Clock::now() < end) {
    if (auto heard = packet(3, 20)) {
      last = std::move(heard);
      if (last->size() == 10 && number_at(*last, 4) != 0) {
        break;
      }
    }
  }
  return last;
}

by_hand::Bytes Partner::take(std::size_t size) {
  constexpr int kPatienceMs = 2'000;
  const auto end = Clock::now() + std::chrono::milliseconds(kPatienceMs);
  while (stream_.size() < size && Clock::now() < end) {
    const auto heard = packet(0, 20);
    if (!heard || heard->size() < 4) {
      continue;
    }
    const Bytes payload(heard->begin() + 2, heard->end() - 2);
    const Bytes whole =
        by_hand::packet(0, expected_, heard->at(1) & 63, payload, by_hand::session(theirs, mine));
    if (whole == *heard) {
      stream_.insert(stream_.end(), payload.begin(), payload.end());
      expected_ = (expected_ + 1) % 64;
    }
    if (acknowledges) {
      device_.write(by_hand::frame(1, acknowledgement()));
    }
  }
  const auto count = static_cast<std::ptrdiff_t>(std::min(size, stream_.size()));
  const Bytes taken(stream_.begin(), stream_.begin() + count);
  stream_.erase(stream_.begin(), stream_.begin() + count);
  return taken;
}

}  // namespace holdfast::instrument
