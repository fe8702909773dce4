-- A function that calls itself: 150 049 calls.
function Fibonacci(n)
  if n < 2 then return n end
  return Fibonacci(n - 1) + Fibonacci(n - 2)
end
print("> " .. Fibonacci(24))
