function log = read_log(file)
% READ_LOG  Read a log of quadcore, .mat or .csv, into a struct.
%
%   log = quadcore.read_log('flight.mat')
%
% The fields are column vectors: t (s), x, y, z (m), qx, qy, qz, qw (orientation of the frame in the
% world), vx, vy, vz (world axes, m/s), wx, wy, wz (body axes, rad/s). Field j contains the joint
% velocities (rad/s), one column for each rotor. Topics are structs, such as log.topic_reference.x.
% A .mat log also contains its wrenches.
  [~, ~, kind] = fileparts(file);
  switch lower(kind)
    case '.mat'
      log = load(file);
    case '.csv'
      log = read_csv(file);
    otherwise
      error('quadcore:log', '%s: not a .mat or .csv file. Give a log of quadcore.', file);
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
    error('quadcore:log', '%s: cannot be opened. Check the path.', file);
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
