// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/exchange.hpp"

namespace holdfast::agent {

wire::Writer vector_message(wire::MessageType type, std::uint8_t label,
                            const base::Vec6<float>& vector) {
  wire::Writer message(type);
  message.u8(label);
  for (const float value : vector) {
    message.real(static_cast<double>(value));
  }
  return message;
}

base::Vec6<float> read_vector(wire::Reader& in) {
  base::Vec6<float> vector{};
  for (float& value : vector) {
    value = in.real();
  }
  return vector;
}

void Exchange::plan(std::uint16_t count, std::uint16_t behind) {
  left_ = count;
  behind_ = behind;
}

void Exchange::enter() {
  is_under_way_ = false;
  tag_ = 0;
  here_ = {};
}

void Exchange::start(Links& links, const base::Vec6<float>& own) {
  is_under_way_ = true;
  ++tag_;
  links.send(links.used(), vector_message(wire::MessageType::kVector, tag_, own));
}

void Exchange::take(Direction face, std::span<const std::uint8_t> message) {
  wire::Reader in(message);
  const std::size_t slot = in.u8() & 1U;
  vectors_[slot][static_cast<std::size_t>(face)] = read_vector(in);
  here_[slot].add(face);
}

void Exchange::end() {
  here_[slot(0)] = {};
  is_under_way_ = false;
  --left_;
}

}  // namespace holdfast::agent
