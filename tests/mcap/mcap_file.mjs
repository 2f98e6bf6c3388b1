// SPDX-License-Identifier: Apache-2.0
// MCAP files as Foxglove reads them: @mcap/core for the container, @foxglove/rosmsg* for the messages.
import { closeSync, fstatSync, openSync, readSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

// What npm fetched; where it has not, the test ends as skipped.
export function load(fetched) {
  const require = createRequire(join(fetched, "package.json"));
  try {
    return {
      core: require("@mcap/core"),
      rosmsg: require("@foxglove/rosmsg"),
      serialization: require("@foxglove/rosmsg2-serialization"),
      fzstd: require("fzstd"),
    };
  } catch (error) {
    console.log(`skipped: npm has not fetched the reader (${error.code})`);
    return process.exit(77);
  }
}

export class McapFile {
  constructor(path, libraries) {
    this.libraries = libraries;
    this.file = openSync(path, "r");
    this.size = fstatSync(this.file).size;
    this.decompressHandlers = { zstd: (bytes, size) => libraries.fzstd.decompress(bytes, new Uint8Array(Number(size))) };
  }
  close() { closeSync(this.file); }

  read(offset, size) {
    const bytes = new Uint8Array(Number(size));
    const count = readSync(this.file, bytes, 0, bytes.length, Number(offset));
    return bytes.subarray(0, count);
  }

  // By the summary and the indexes, as a viewer seeks.
  indexed() {
    const readable = { size: async () => BigInt(this.size), read: async (offset, size) => this.read(offset, size) };
    return this.libraries.core.McapIndexedReader.Initialize({ readable, decompressHandlers: this.decompressHandlers });
  }

  // Every record from the begin to `end` bytes, all checksums checked, as a file without a summary is read.
  *records(end = this.size) {
    const reader = new this.libraries.core.McapStreamReader({ decompressHandlers: this.decompressHandlers, validateCrcs: true });
    for (let at = 0; at < end; at += 1 << 16) {
      reader.append(this.read(at, Math.min(1 << 16, end - at)));
      for (let record = reader.nextRecord(); record !== undefined; record = reader.nextRecord()) yield record;
    }
    if (end === this.size && !reader.done()) throw new Error("the file has no end");
  }

  // What turns the bytes of a message into its fields, by the schema that the file carries.
  decoder(schema) {
    if (schema.encoding !== "ros2msg") throw new Error(`schema ${schema.name} is written in ${schema.encoding}`);
    const definition = this.libraries.rosmsg.parse(new TextDecoder().decode(schema.data), { ros2: true });
    return new this.libraries.serialization.MessageReader(definition);
  }
}
