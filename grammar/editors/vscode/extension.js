// SPDX-License-Identifier: GPL-3.0-or-later
// Starts `pnr lsp` and lets the editor talk to it.
"use strict";
const { workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

function activate() {
  const settings = workspace.getConfiguration("pnr");
  const folders = settings.get("library").flatMap((folder) => ["-L", folder]);
  const server = { command: settings.get("program"), args: ["lsp", ...folders] };
  client = new LanguageClient("pnr", "pnr", server, { documentSelector: [{ language: "pnr" }] });
  return client.start();
}

function deactivate() {
  return client ? client.stop() : undefined;
}

module.exports = { activate, deactivate };
