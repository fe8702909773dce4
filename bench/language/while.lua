-- Five million passes of while, with globals, as the scene language has them.
Pass = 0
Sum = 0
while Pass < 5000000 do
  Sum = Sum + math.fmod(Pass, 7) * 0.5 - Sum / 1000
  Pass = Pass + 1
end
print(string.format("> %.6f", Sum))
