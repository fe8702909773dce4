" Vim syntax: vts, a scene description language for volumetric textures, and POV-Ray's SDL.
" Written by editors/make.sh from editors/templates/syntax.vim: change that one.
if exists("b:current_syntax")
  finish
endif
let s:cpo = &cpo
set cpo&vim
syn case match
syn iskeyword @,48-57,_

@vim_functions@
@vim_constants@
@vim_colors@
@vim_words@

syn match vtsNumber "\%(\h\w*\)\@<!\%(\d\+\.\=\d*\|\.\d\+\)\%([eE][-+]\=\d\+\)\=" display
syn match vtsMember "\.\%([xyztuv]\|red\|green\|blue\|filter\|transmit\|gray\)\>" display
syn match vtsCall "\<\h\w*\ze\s*(" display
syn match vtsDirective "#\s*\%(@vim_directives@\)\>" display
syn match vtsName "\%(#\s*\%(declare\|local\|undef\|macro\)\s\+\%(deprecated\s\+\)\=\)\@40<=\h\w*" display

syn region vtsBraces start="{" end="}" transparent fold contains=TOP
@vim_blocks@

" Without `contains`, what the block around them may hold.
syn region vtsFold matchgroup=vtsDirective start="#\s*\%(if\|ifdef\|ifndef\|while\|for\|switch\|macro\)\>" end="#\s*end\>" transparent fold

syn match vtsEscape "\\\%(u\x\{4}\|.\)" contained
syn region vtsString start=+"+ skip=+\\.+ end=+"+ contains=vtsEscape,@Spell
syn keyword vtsTodo TODO FIXME XXX contained
syn match vtsComment "//.*$" contains=vtsTodo,@Spell
syn region vtsComment start="/\*" end="\*/" contains=vtsComment,vtsTodo,@Spell fold
syn sync minlines=300

hi def link vtsFunction Function
hi def link vtsConstant Constant
hi def link vtsColor Type
hi def link vtsWord Statement
hi def link vtsBlock Type
hi def link vtsItem Identifier
hi def link vtsNumber Number
hi def link vtsMember Identifier
hi def link vtsCall Function
hi def link vtsDirective PreProc
hi def link vtsName Identifier
hi def link vtsString String
hi def link vtsEscape SpecialChar
hi def link vtsComment Comment
hi def link vtsTodo Todo

let b:current_syntax = "vts"
let &cpo = s:cpo
unlet s:cpo
