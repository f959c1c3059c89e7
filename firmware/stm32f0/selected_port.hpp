// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "flash_port.hpp"
#include "stm32f0_port.hpp"

namespace holdfast::firmware {

using SelectedPort = stm32f0::Stm32f0Port;
using FlashPort = stm32f0::FlashPort;

}  // namespace holdfast::firmware
