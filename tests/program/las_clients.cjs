// SPDX-License-Identifier: Apache-2.0
// Opens the LAS or LAZ file in OUT/points of a run with copc.js, which decompresses by laz-perf. Compares it with the LAS or LAZ
// inputs, read by copc.js too, and with the run's other results.
//     node las_clients.cjs FOLDER_OF_COPC OUT las|laz INPUT...
"use strict";
const assert = require("node:assert/strict");
const fs = require("node:fs");
const path = require("node:path");

const [folder, out, extension, ...inputs] = process.argv.slice(2);
const { Las } = require(path.join(folder, "node_modules", "copc"));

const RESULTS = [["probability", "float", 4], ["angle", "float", 4], ["halfdisc", "float", 4], ["shape", "float", 4],
  ["boundary", "unsigned", 1], ["coherent", "unsigned", 1], ["loop", "signed", 4]];
// copc.js 0.0.8 looks for a description behind the name, not where LAS 1.4 R15, table 24, has it.
const description = (record, i) => record.subarray(192 * i + 160, 192 * i + 192).toString("latin1").replace(/\0.*$/s, "");

async function open(file) {
  const bytes = fs.readFileSync(file);
  const header = Las.Header.parse(bytes);
  const records = await Las.Vlr.walk(file, header);
  for (const record of records) record.data = Buffer.from(await Las.Vlr.fetch(file, record));
  const described = Las.Vlr.find(records, "LASF_Spec", 4);
  const extra = described ? Las.ExtraBytes.parse(described.data) : [];
  extra.forEach((one, i) => { one.description = description(described.data, i); });
  const start = header.pointDataOffset, length = header.pointCount * header.pointDataRecordLength;
  const isCompressed = (bytes[104] & 0x80) !== 0;
  const points = isCompressed ? await Las.PointData.decompressFile(bytes) : bytes.subarray(start, start + length);
  return { bytes, header, records, extra, isCompressed, count: header.pointCount, view: Las.View.create(points, header, extra) };
}

// Reads a little-endian PLY file with one element.
function readPly(file) {
  const bytes = fs.readFileSync(file);
  const end = bytes.indexOf("end_header\n") + 11;
  const readers = { double: ["readDoubleLE", 8], float: ["readFloatLE", 4], uint: ["readUInt32LE", 4], int: ["readInt32LE", 4] };
  const columns = [...bytes.toString("latin1", 0, end).matchAll(/^property (\w+) (\w+)$/gm)].map((match) => match.slice(1));
  const rows = [];
  for (let at = end; at < bytes.length;) {
    const row = {};
    for (const [type, name] of columns) {
      row[name] = bytes[readers[type][0]](at);
      at += readers[type][1];
    }
    rows.push(row);
  }
  return rows;
}

function checkHeader(las, sources) {
  const { header, bytes, view, count } = las, first = sources[0].header;
  assert.equal(`${header.majorVersion}.${header.minorVersion}`, "1.4");
  assert.equal(count, sources.reduce((sum, source) => sum + source.count, 0));
  assert.equal(count, view.pointCount);
  const format = header.pointDataRecordFormat;
  for (const { header: from } of sources) assert(format === from.pointDataRecordFormat || (sources.length > 1 && format >= 6));
  for (const name of ["fileSourceId", "projectId", "systemIdentifier", "fileCreationDayOfYear", "fileCreationYear"])
    assert.equal(header[name], first[name], name);
  assert(header.generatingSoftware.startsWith("Lacuna "));
  if (sources.length === 1) {
    for (const name of ["globalEncoding", "scale", "offset", "min", "max"]) assert.deepEqual(header[name], first[name], name);
  } else {
    const textBit = format >= 6 ? 16 : 0;
    assert.equal(header.globalEncoding, (first.globalEncoding & ~16) | textBit);
  }
  // Behind the points and the records there is nothing. A chunk table, behind compressed points, has its number of chunks in it.
  const last = las.records.filter((record) => record.isExtended).at(-1);
  if (last) assert.equal(bytes.length, last.contentOffset + last.contentLength);
  if (las.isCompressed) {
    const table = Number(bytes.readBigInt64LE(header.pointDataOffset));
    assert(table > header.pointDataOffset && table + 8 < (last ? header.evlrOffset : bytes.length));
    assert.deepEqual([bytes.readUInt32LE(table), bytes.readUInt32LE(table + 4)], [0, Math.ceil(count / 50_000)]);
  } else {
    const end = header.pointDataOffset + count * header.pointDataRecordLength;
    assert.equal(last ? header.evlrOffset : bytes.length, end);
  }

  const returns = Array(16).fill(0), number = view.getter("ReturnNumber");
  for (let i = 0; i < count; ++i) ++returns[number(i)];
  assert.deepEqual(header.pointCountByReturn, returns.slice(1));
  const legacy = Array.from({ length: 6 }, (_, i) => bytes.readUInt32LE(107 + 4 * i));
  assert.deepEqual(legacy, format < 6 ? [count, ...returns.slice(1, 6)] : Array(6).fill(0));
  ["X", "Y", "Z"].forEach((name, axis) => {
    const get = view.getter(name);
    let min = Infinity, max = -Infinity;
    for (let i = 0; i < count; ++i) [min, max] = [Math.min(min, get(i)), Math.max(max, get(i))];
    assert(Math.abs(header.min[axis] - min) < 1e-6 && Math.abs(header.max[axis] - max) < 1e-6, `bounds ${name}`);
  });
}

// Those of the first source. If it states no coordinate reference system, that of the next one that does holds.
function checkRecords(las, sources) {
  const kept = (record) => record.userId !== "laszip encoded" && !(record.userId === "LASF_Spec" && record.recordId === 4);
  const plain = ({ userId, recordId, description, isExtended, data }) => ({ userId, recordId, description, isExtended, data });
  const systems = ({ records }) => records.filter((record) => record.userId === "LASF_Projection");
  const expected = sources[0].records.filter(kept).map(plain), found = las.records.filter(kept);
  if (systems(sources[0]).length > 0) return assert.deepEqual(found.map(plain), expected);
  const others = found.filter((record) => record.userId !== "LASF_Projection");
  assert.deepEqual(others.map(plain), expected);
  const stated = sources.map(systems).find((records) => records.length > 0) ?? [];
  assert.deepEqual(systems(las).map(({ data }) => data), stated.map(({ data }) => data));
}

function checkExtra(las, sources) {
  const own = new Map();
  for (const source of sources) for (const one of source.extra) own.set(one.name, one);
  assert.deepEqual(las.extra.slice(0, own.size), [...own.values()]);
  const results = las.extra.slice(own.size);
  const name = (given) => (own.has(given) ? `lacuna_${given}` : given);
  const found = results.map(({ name, type, length, description }) => [name, type, length, description]);
  assert.deepEqual(found,
    RESULTS.map(([given, type, length]) => [name(given), type, length, `Lacuna: ${given}`]));
  return name;
}

// Each value of a source's points, but those that its point format cannot hand over as they are.
function checkPoints(las, sources) {
  let first = 0;
  for (const source of sources) {
    const isWidened = las.header.pointDataRecordFormat >= 6 && source.header.pointDataRecordFormat < 6;
    for (const name of Object.keys(source.view.dimensions)) {
      const before = source.view.getter(name), after = las.view.getter(name);
      const isPlace = ["X", "Y", "Z"].includes(name) && sources.length > 1;
      const margin = isPlace ? 1e-8 : name === "ScanAngle" && isWidened ? 0.003 : 0;  // of rounding
      for (let i = 0; i < source.count; ++i) {
        const from = before(i), to = after(first + i);
        const isOverlap = isWidened && name === "Classification" && source.view.getter("Overlap")(i);
        if (Object.is(from, to) || Math.abs(from - to) <= margin || (isOverlap && to === 1)) continue;
        assert.fail(`${name} of point ${i}: ${from} became ${to}`);
      }
    }
    for (const { name, type, nodata = 0 } of las.extra) {  // those that this file does not have
      const has = ({ extra }) => extra.some((one) => one.name === name);
      if (!type || has(source) || !sources.some(has)) continue;
      for (let i = 0; i < source.count; ++i)
        assert.equal(las.view.getter(name)(first + i), type === "float" ? NaN : nodata, name);
    }
    first += source.count;
  }
}

function checkResults({ view, count }, name) {
  const get = Object.fromEntries(RESULTS.map(([given]) => [given, view.getter(name(given))]));
  for (let i = 0; i < count; ++i) assert(get.probability(i) >= 0 && get.probability(i) <= 1, `probability of point ${i}`);
  const place = ["X", "Y", "Z"].map((axis) => view.getter(axis));
  const isNear = (row, id) => ["x", "y", "z"].every((axis, i) => Math.abs(row[axis] - place[i](id)) < 1e-8);
  const boundary = readPly(path.join(out, "boundary.ply"));
  assert(boundary.length > 0);
  for (const row of boundary) {
    const id = row.scalar_id;
    assert(isNear(row, id), `place of point ${id}`);
    assert.equal(get.loop(id), row.scalar_loop);
    if (row.scalar_loop !== -1) continue;  // that of a point on a loop is of the level of the loop
    assert.equal(get.probability(id), row.scalar_probability);
    assert.equal(get.boundary(id), 1);
  }
  const { loops } = JSON.parse(fs.readFileSync(path.join(out, "holes.json"), "utf8"));
  const loopsOf = new Map();
  for (const loop of loops) {
    loop.ids.forEach((id, i) => {
      const [x, y, z] = loop.coordinates[i];
      assert(isNear({ x, y, z }, id), `place of point ${id} in loop ${loop.id}`);
      loopsOf.set(id, [...(loopsOf.get(id) ?? []), loop.id]);
    });
  }
  assert(loopsOf.size > 0);
  for (let i = 0; i < count; ++i) assert((loopsOf.get(i) ?? [-1]).includes(get.loop(i)), `loop of point ${i}`);
}

(async () => {
  const found = fs.readdirSync(path.join(out, "points"));
  assert.deepEqual(found, [`${path.parse(inputs[0]).name}.${extension}`]);
  const las = await open(path.join(out, "points", found[0]));
  assert.equal(las.isCompressed, extension === "laz");
  const sources = await Promise.all(inputs.map(open));
  checkHeader(las, sources);
  checkRecords(las, sources);
  const name = checkExtra(las, sources);
  checkPoints(las, sources);
  checkResults(las, name);
})().catch((error) => {
  console.error(`${out}: ${error.message}`);
  process.exit(1);
});
