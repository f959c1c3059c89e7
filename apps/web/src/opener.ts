// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { unpacked } from './core/packed';

/** Puts the page's own script into it, unpacked. What stands in main.ts is a third as long in this way. */
const script = document.createElement('script');
script.type = 'module';
script.textContent = await unpacked('holdfast-script').text();
document.body.append(script);
