function log = read_log(file)
% READ_LOG  Read a log of quadcore, .mat or .csv.
%
%   log = quadcore.read_log('flight.mat')
%
% A struct of column vectors: t (s), x, y, z (m), qx, qy, qz, qw (of the frame in the world), vx,
% vy, vz (world axes, m/s), wx, wy, wz (body axes, rad/s), and j, the joint velocities (rad/s), a
% column for each rotor. Of a .mat file also the wrenches, as it has them. Topics are structs:
% log.topic_reference.x and so on.
  [~, ~, kind] = fileparts(file);
  switch lower(kind)
    case '.mat'
      log = load(file);
    case '.csv'
      log = read_csv(file);
    otherwise
      error('quadcore:log', '%s: a log is a .mat or a .csv file', file);
  end
  log.j = [];
  rotor = 1;
  while isfield(log, sprintf('j%d', rotor))
    name = sprintf('j%d', rotor);
    log.j = [log.j, log.(name)(:)];
    log = rmfield(log, name);
    rotor = rotor + 1;
  end
end

function log = read_csv(file)
  stream = fopen(file);
  if stream < 0
    error('quadcore:log', '%s: cannot be read', file);
  end
  names = strsplit(strtrim(fgetl(stream)), ',');
  rows = textscan(stream, repmat('%f', 1, numel(names)), 'Delimiter', ',', 'CommentStyle', '#');
  fclose(stream);
  log = struct();
  for i = 1:numel(names)
    parts = strsplit(names{i}, '.');
    if numel(parts) == 1
      log.(names{i}) = rows{i};
    else
      log.(['topic_', parts{1}]).(parts{2}) = rows{i};
    end
  end
end
