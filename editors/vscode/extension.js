// The client of `etlc lsp`: starts the server, and tells it when a file that specs load changes.
'use strict';

const { workspace } = require('vscode');
const { LanguageClient, TransportKind } = require('vscode-languageclient/node');

let client;

function activate() {
  const server = {
    command: workspace.getConfiguration('etlc').get('path'),
    args: ['lsp'],
    transport: TransportKind.stdio,
  };
  const options = {
    documentSelector: [{ language: 'etl' }],
    synchronize: { fileEvents: workspace.createFileSystemWatcher('**/*.{npy,npz,csv,h5,json}') },
  };
  client = new LanguageClient('etlc', 'etlc', server, options);
  return client.start();
}

function deactivate() {
  return client === undefined ? undefined : client.stop();
}

module.exports = { activate, deactivate };
