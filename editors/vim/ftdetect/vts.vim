" POV-Ray's scenes are scenes of vts, too; an .inc file is one where it looks like it. `let g:vts_only = 1` leaves both alone.
au BufRead,BufNewFile *.vts set filetype=vts
if !get(g:, 'vts_only', 0)
  au BufRead,BufNewFile *.pov set filetype=vts
  au BufRead,BufNewFile *.inc if getline(1, 50)->join("\n") =~# '\v(^|\n)\s*#\s*(declare|local|macro|ifndef|version|default)>' | set filetype=vts | endif
endif
