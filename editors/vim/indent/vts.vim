" Vim indent: vts scenes. A level for each open bracket and each directive that waits for its #end.
if exists("b:did_indent")
  finish
endif
let b:did_indent = 1
setlocal indentexpr=VtsIndent(v:lnum) indentkeys=0{,0},0),0],0#,!^F,o,O,=end,=else,=elseif
let b:undo_indent = "setlocal inde< indk<"
if exists("*VtsIndent")
  finish
endif

" The line without strings and comments.
function s:Code(lnum)
  let l:text = substitute(getline(a:lnum), '"\%(\\.\|[^"\\]\)*"', '""', 'g')
  return substitute(l:text, '//.*\|/\*.\{-}\%(\*/\|$\)', '', 'g')
endfunction

function s:Count(text, pattern)
  return len(split(a:text, a:pattern, 1)) - 1
endfunction

let s:opens = '[{(\[]\|#\s*\%(if\|ifdef\|ifndef\|while\|for\|switch\|macro\)\>'
let s:closes = '[})\]]\|#\s*end\>'
" What stands at the beginning of a line and belongs to the level before.
let s:leads = '^\s*\%(\%([})\]]\|#\s*end\>\)\s*\)*'

function VtsIndent(lnum)
  let l:before = prevnonblank(a:lnum - 1)
  if l:before == 0
    return 0
  endif
  let l:text = s:Code(l:before)
  let l:lead = matchstr(l:text, s:leads)
  let l:rest = strpart(l:text, len(l:lead))
  let l:level = s:Count(l:rest, s:opens) - s:Count(l:rest, s:closes)
  if l:rest =~# '^#\s*\%(else\|elseif\)\>'
    let l:level += 1
  endif
  let l:here = s:Code(a:lnum)
  let l:level -= s:Count(matchstr(l:here, s:leads), s:closes)
  if l:here =~# '^\s*#\s*\%(else\|elseif\)\>'
    let l:level -= 1
  endif
  return max([0, indent(l:before) + l:level * shiftwidth()])
endfunction
