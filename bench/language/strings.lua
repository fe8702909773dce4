-- A table of 200 000 numbers, then each row joined to a text.
Table = {}
for row = 0, 999 do
  Table[row] = {}
  for column = 0, 199 do Table[row][column] = row * 200 + column end
end
Letters = 0
for row = 0, 999 do
  local line = ""
  for column = 0, 199 do line = line .. string.format("%.0f", Table[row][column]) .. "," end
  Letters = Letters + #line
end
print("> " .. Letters)
