" Vim: vts scenes
if exists("b:did_ftplugin")
  finish
endif
let b:did_ftplugin = 1

setlocal comments=s1:/*,mb:*,ex:*/,:// commentstring=//\ %s
setlocal formatoptions-=t formatoptions+=croql
setlocal suffixesadd=.inc,.vts,.pov include=^\\s*#\\s*include
setlocal define=^\\s*#\\s*\\%(declare\\\|local\\\|macro\\)
setlocal makeprg=vts\ check\ %:S
setlocal errorformat=%f:%l:%c:\ %trror:\ %m,%f:%l:%c:\ %tarning:\ %m,%f:%l:%c:\ %tote:\ %m,%-G%.%#
" Folds are there, all of them open: zc closes one.
setlocal foldmethod=syntax foldlevel=99

" % goes from #if to #else to #end (with the plugin matchit).
let b:match_ignorecase = 0
let b:match_words = '#\s*\%(if\|ifdef\|ifndef\|while\|for\|switch\|macro\)\>:#\s*\%(elseif\|else\|case\|range\)\>:#\s*end\>'

let b:undo_ftplugin = "setlocal com< cms< fo< sua< inc< def< mp< efm< fdm< fdl< | unlet! b:match_ignorecase b:match_words"
