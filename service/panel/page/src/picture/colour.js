// SPDX-License-Identifier: Apache-2.0
// A colour as three bytes, linear, as attributes of corners carry it.
export const bytesOf = (colour) => colour.toArray().map((part) => Math.round(255 * part));
