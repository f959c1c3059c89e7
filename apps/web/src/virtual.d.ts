// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

/** Made by vite.config.ts. */
declare module 'virtual:scenarios' {
  /** The files of scenarios/, by name. */
  const scenarios: Record<string, object>;
  export default scenarios;
}

declare module 'virtual:vocabulary' {
  /** What the core says of itself. */
  const vocabulary: import('./core/types').Vocabulary;
  export default vocabulary;
}
