function numbers = request(client, kind, numbers)
% REQUEST  Send a message of the protocol (docs/serve.md) and return the numbers of the answer.
%
% Raises an error with the reason if the server refuses the request or the flight has failed.
  message = [kind, numel(numbers), numbers(:)'];
  write(client.socket, typecast(double(message), 'uint8'));
  head = receive(client.socket, 2);
  numbers = receive(client.socket, head(2));
  if head(1) ~= 0
    error('quadcore:server', '%s', char(numbers));
  end
end

function numbers = receive(socket, count)
  bytes = zeros(1, 0, 'uint8');
  while numel(bytes) < 8 * count
    piece = read(socket, 8 * count - numel(bytes));
    if isempty(piece)
      error('quadcore:server', 'The server closed the connection. Start `quadcore serve` again.');
    end
    bytes = [bytes, uint8(piece(:)')]; %#ok<AGROW>
  end
  numbers = typecast(bytes, 'double');
end
