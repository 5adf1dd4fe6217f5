" SPDX-License-Identifier: GPL-3.0-or-later
" Comments, layout by `pnr fmt`, problems by `pnr check` (:make), and in Neovim the language server.
if exists('b:did_ftplugin')
    finish
endif
let b:did_ftplugin = 1
setlocal commentstring=//\ %s comments=://
setlocal formatprg=pnr\ fmt
setlocal makeprg=pnr\ check\ %:S
setlocal errorformat=%f:%l:%c:\ %trror:\ %m,%f:%l:%c:\ %tarning:\ %m,%-G%.%#
setlocal keywordprg=:!pnr\ help
if has('nvim')
    lua vim.lsp.start({ name = 'pnr', cmd = { 'pnr', 'lsp' }, root_dir = vim.fn.expand('%:p:h') })
endif
