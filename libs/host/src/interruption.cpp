// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/interruption.hpp"

#include <utility>

namespace holdfast::host {
namespace {

/// The object whose `ask` is called on each thread; usually none.
thread_local const Interruptible* asked = nullptr;

}  // namespace

Interruptible::Interruptible(std::function<void()> ask)
    : ask_(std::move(ask)), before_(std::exchange(asked, this)) {}

Interruptible::~Interruptible() { asked = before_; }

void ask_whether_to_go_on() {
  if (asked != nullptr) {
    asked->ask_();
  }
}

bool is_interruptible() { return asked != nullptr; }

}  // namespace holdfast::host
