// SPDX-License-Identifier: GPL-3.0-or-later
// `npm test`: the extension as an editor starts it, against the real `pnr lsp` (PNR names another program). The editor
// and its client library are stood in for by what this file says: nothing needs to be installed.
"use strict";
const assert = require("node:assert");
const { spawn } = require("node:child_process");
const Module = require("node:module");
const path = require("node:path");
const test = require("node:test");

const program = process.env.PNR || "pnr";

// Messages over a process's standard input and output, framed by their length.
class LanguageClient {
  constructor(id, name, server, options) {
    assert.deepStrictEqual(options.documentSelector, [{ language: "pnr" }]);
    this.server = server;
    this.answers = new Map(); // by the request's number
    this.listeners = new Map(); // by the notification's method
    this.number = 0;
    this.bytes = Buffer.alloc(0);
    LanguageClient.started = this;
  }
  async start() {
    this.process = spawn(this.server.command, this.server.args, { stdio: ["pipe", "pipe", "inherit"] });
    this.ended = new Promise((done, failed) => this.process.on("exit", done).on("error", failed));
    this.process.stdout.on("data", (data) => this.read(data));
    const said = await this.request("initialize", { processId: null, rootUri: null, capabilities: {} });
    this.capabilities = said.capabilities;
    this.notify("initialized", {});
  }
  async stop() {
    await this.request("shutdown", null);
    this.notify("exit", null);
    return this.ended;
  }
  read(data) {
    this.bytes = Buffer.concat([this.bytes, data]);
    for (;;) {
      const end = this.bytes.indexOf("\r\n\r\n");
      if (end < 0) return;
      const length = Number(/Content-Length: (\d+)/i.exec(this.bytes.toString("ascii", 0, end))[1]);
      if (this.bytes.length < end + 4 + length) return;
      const message = JSON.parse(this.bytes.toString("utf8", end + 4, end + 4 + length));
      this.bytes = this.bytes.subarray(end + 4 + length);
      if (message.method) this.listeners.get(message.method)?.(message.params);
      else this.answers.get(message.id)(message.result);
    }
  }
  send(message) {
    const text = JSON.stringify({ jsonrpc: "2.0", ...message });
    this.process.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  }
  notify(method, params) {
    this.send({ method, params });
  }
  request(method, params) {
    const id = ++this.number;
    return new Promise((done) => {
      this.answers.set(id, done);
      this.send({ id, method, params });
    });
  }
  next(method) {
    return new Promise((done) => this.listeners.set(method, done));
  }
}

const settings = { program, library: ["/nowhere"] };
const standIns = {
  vscode: { workspace: { getConfiguration: () => ({ get: (name) => settings[name] }) } },
  "vscode-languageclient/node": { LanguageClient },
};
const load = Module._load;
Module._load = (name, ...rest) => standIns[name] || load(name, ...rest);
const folder = path.join(__dirname, "..");
const described = require(path.join(folder, "package.json"));

test("the extension starts pnr lsp, which tells of a mistake, explains a word and completes", async () => {
  const extension = require(path.join(folder, described.main));
  await extension.activate();
  const client = LanguageClient.started;
  assert.deepStrictEqual(client.server.args, ["lsp", "-L", "/nowhere"]);
  for (const can of ["hoverProvider", "completionProvider", "renameProvider", "documentFormattingProvider"])
    assert.ok(client.capabilities[can], can);

  const uri = "file:///pot.pnr";
  const text = "sphere { 0, 1 pigmnt { rgb 1 } }\n";
  const problems = client.next("textDocument/publishDiagnostics");
  client.notify("textDocument/didOpen", { textDocument: { uri, languageId: "pnr", version: 1, text } });
  const { diagnostics } = await problems;
  assert.ok(diagnostics.some((each) => /did you mean `pigment`/.test(each.message)), JSON.stringify(diagnostics));
  const at = { textDocument: { uri }, position: { line: 0, character: 2 } };
  assert.match(JSON.stringify(await client.request("textDocument/hover", at)), /centre, radius/);
  const inside = { textDocument: { uri }, position: { line: 0, character: 14 } };
  const completion = await client.request("textDocument/completion", inside);
  assert.ok((completion.items || completion).some((item) => item.label === "pigment"));
  assert.strictEqual(await extension.deactivate(), 0);
});

test("every file that package.json names is there, and its settings are those that the extension reads", () => {
  const { languages, grammars, snippets, configuration } = described.contributes;
  for (const file of [languages[0].configuration, grammars[0].path, snippets[0].path]) require(path.join(folder, file));
  for (const name of Object.keys(settings)) assert.ok(configuration.properties[`pnr.${name}`], name);
});
