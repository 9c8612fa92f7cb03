-- A real client: Neovim opens a spec with a mistake, and its user mends it.
-- Called by neovim_test.sh, which names the spec in SPEC, with the settings of docs/editors.md.
local most = 280000 -- milliseconds; long, since a busy machine is slow

local function wait_for(what, ready)
  assert(vim.wait(most, ready, 20), "waited in vain for " .. what)
end

local function messages()
  return vim.tbl_map(function(d) return d.message end, vim.diagnostic.get(0))
end

local function find(words)
  vim.fn.cursor(1, 1)
  assert(vim.fn.search("\\V" .. words, "cW") > 0, words .. " is not in the text")
end

local function ask(method, more)
  local params = vim.tbl_extend("force", vim.lsp.util.make_position_params(), more or {})
  local answers = vim.lsp.buf_request_sync(0, method, params, most)
  local _, answer = next(answers)
  assert(answer and not answer.err, vim.inspect(answers))
  return answer.result
end

local function test()
  vim.o.swapfile = false
  vim.cmd("edit " .. vim.env.SPEC)
  assert(vim.bo.filetype == "etl", "the file has the type '" .. vim.bo.filetype .. "'")
  local client
  wait_for("a client", function()
    client = next(vim.lsp.buf_get_clients(0))
    return client ~= nil
  end)

  -- The mistake is seen; an unsaved edit mends it.
  wait_for("a diagnostic", function() return #messages() > 0 end)
  assert(messages()[1]:find("'at_bai' is not declared", 1, true), vim.inspect(messages()))
  assert(vim.diagnostic.get(0)[1].lnum == 6)
  find("at_bai")
  local range = vim.lsp.util.make_range_params().range
  local actions = ask("textDocument/codeAction", { range = range, context = { diagnostics = {} } })
  assert(#actions == 1 and actions[1].title == "Change 'at_bai' to 'at_bay'", vim.inspect(actions))
  vim.lsp.util.apply_workspace_edit(actions[1].edit, "utf-16")
  wait_for("no diagnostic", function() return #messages() == 0 end)

  -- What is this, and where is it from?
  find("at_bay;")
  local hover = ask("textDocument/hover")
  assert(hover.contents.value:find("Threshold 0.25", 1, true), vim.inspect(hover))
  vim.lsp.buf.definition()
  wait_for("the definition", function() return vim.fn.line(".") == 6 end)
  assert(vim.fn.expand("<cword>") == "at_bay")

  vim.lsp.buf.rename("near_bay")
  wait_for("the new name", function()
    return vim.fn.getline(7):find("near_bay", 1, true) ~= nil
  end)
  assert(vim.fn.getline(6):find("predicate near_bay", 1, true), vim.fn.getline(6))
  -- The line has two characters beyond the basic plane before the name.
  assert(vim.fn.getline(7) == "/* 🚀🤖 */ monitor arrive = F near_bay;", vim.fn.getline(7))

  -- What may stand here?
  vim.fn.append("$", "let l = ")
  vim.fn.cursor(vim.fn.line("$"), 1)
  local position = { line = vim.fn.line("$") - 1, character = 8 }
  local labels = vim.tbl_map(function(item) return item.label end,
    ask("textDocument/completion", { position = position }).items)
  assert(vim.tbl_contains(labels, "near_bay") and vim.tbl_contains(labels, "always"),
    vim.inspect(labels))
  vim.fn.setline("$", "let l = G near_bay;  // as long as it runs")

  wait_for("a warning", function() return #messages() == 1 end)
  assert(#ask("textDocument/documentSymbol") == 6)

  vim.lsp.stop_client(client)
  wait_for("the end of the server", function() return vim.lsp.client_is_stopped(client) end)
end

local good, why = pcall(test)
if not good then io.stderr:write("FAILED: " .. tostring(why) .. "\n") end
vim.cmd(good and "qall!" or "cquit!")
