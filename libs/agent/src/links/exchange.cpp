// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/links/exchange.hpp"

#include "holdfast/agent/messages/messages.hpp"

namespace holdfast::agent {

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

void Exchange::take(MoreFaces* more, Direction face, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const std::size_t slot = in.label & 1U;
  const auto i = static_cast<std::size_t>(face);
  if (!kIsGeneral || i < vectors_[slot].size()) {
    vectors_[slot][i] = in.vector;
  } else {
    more->vectors[slot][i - vectors_[slot].size()] = in.vector;
  }
  here_[slot].add(face);
}

void Exchange::end() {
  here_[slot(0)] = {};
  is_under_way_ = false;
  --left_;
}

}  // namespace holdfast::agent
