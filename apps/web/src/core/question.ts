// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Cancelled, CoreClient } from './client';

/** A question to a core of its own, of which only the newest is answered. */
export class Question {
  private readonly client = new CoreClient();
  private asked = 0;

  /** Undefined: it was given up, or another one came. Throws CoreError. */
  async ask<Value>(ask: (core: CoreClient) => Promise<Value>): Promise<Value | undefined> {
    this.cancel();
    const { asked } = this;
    try {
      const value = await ask(this.client);
      return asked === this.asked ? value : undefined;
    } catch (error) {
      if (error instanceof Cancelled || asked !== this.asked) {
        return undefined;
      }
      throw error;
    }
  }

  get isBusy(): boolean {
    return this.client.isBusy;
  }

  cancel(): void {
    ++this.asked;
    if (this.client.isBusy) {
      this.client.cancel();
    }
  }
}
